"""A case of the validation page: where its figures come from, what was given and fitted, and rows of comparison."""
from __future__ import annotations

import dataclasses
import io
import re
from collections.abc import Callable
from typing import Any

MET, MISSED, SHOWN = "within", "MISSED", "shown"


@dataclasses.dataclass
class Row:
    """One quantity: published or measured against computed."""
    quantity: str
    unit: str
    reference: float
    computed: float
    settings: str = ""  #: mesh, step, operation
    bound: float | None = None  #: largest error that is accepted; None: the row is only shown
    scale: float | None = None  #: the error is the difference over this; None: over the reference
    fitted: str = ""  #: what was fitted for this row; "": as the case says

    @property
    def error(self) -> float:
        """(computed - reference)/scale."""
        return (self.computed - self.reference) / (abs(self.reference) if self.scale is None else self.scale)

    @property
    def verdict(self) -> str:
        """Whether the error is within its bound."""
        return SHOWN if self.bound is None else MET if abs(self.error) <= self.bound else MISSED


@dataclasses.dataclass
class Case:
    """A case and its comparison."""
    name: str
    title: str
    kind: str  #: "measured" or "published"
    source: str
    doi: str
    given: str
    fitted: str
    rows: list[Row]
    note: str = ""
    licence: str = ""
    pictures: list[str] = dataclasses.field(default_factory=list)  #: SVG
    seconds: float = 0.0

    @property
    def verdict(self) -> str:
        """MISSED if one row is; "shown" if none has a bound."""
        found = {row.verdict for row in self.rows}
        return MISSED if MISSED in found else MET if MET in found else SHOWN


#: Name of a case: its function (called with True for pictures), and whether it runs in the tests.
CASES: dict[str, tuple[Callable[[bool], Case], bool]] = {}


def case(name: str, quick: bool = True) -> Callable[[Callable[[bool], Case]], Callable[[bool], Case]]:
    """Enters a function into the list of cases."""
    def enter(function: Callable[[bool], Case]) -> Callable[[bool], Case]:
        CASES[name] = function, quick
        return function
    return enter


def picture(draw: Callable[[Any], None], columns: int = 1, width: float = 7.0, height: float = 3.4) -> str:
    """SVG of a figure that `draw` draws into its axes; the same text each time."""
    import matplotlib
    matplotlib.use("Agg")
    import matplotlib.pyplot as plt
    settings = {"svg.fonttype": "none", "svg.hashsalt": "drillmbd", "font.size": 9, "axes.spines.top": False,
                "axes.spines.right": False, "axes.grid": True, "grid.color": "#dddddd", "legend.frameon": False,
                "axes.axisbelow": True, "font.family": "DejaVu Sans", "figure.constrained_layout.use": True}
    with plt.rc_context(settings):
        figure, axes = plt.subplots(1, columns, figsize=(width, height))
        draw(axes)
        text = io.StringIO()
        figure.savefig(text, format="svg", metadata={"Date": None})
        plt.close(figure)
    return re.sub(r"^.*?(?=<svg)", "", text.getvalue(), flags=re.DOTALL)
