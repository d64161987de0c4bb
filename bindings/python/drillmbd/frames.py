"""Results as pandas frames, units in the names of their columns; lists that can become one."""
from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import Any, Dict, List

from ._optional import need
from ._structs import SpeedBand, SpeedsReport


class SpeedBands(List[SpeedBand]):
    """Bands of rotary speed to avoid, with the status of the call and its SpeedsReport. `speeds` [rad/s] and `severity`
    [-] are those of the grid, shape (points) each."""

    def __init__(self) -> None:
        super().__init__()
        self.status = 0
        self.report = SpeedsReport()
        self.speeds: list[float] = []
        self.severity: list[float] = []

    def _asdict(self) -> dict[str, list[Any]]:
        """The fields of all bands by name."""
        return by_field(SpeedBand, self)

    def frame(self) -> Any:
        """The bands as a pandas frame, one row each, units in the names of its columns."""
        return frame_of(SpeedBand, self)

    def severity_frame(self) -> Any:
        """Severity over rotary speed as a pandas frame."""
        return need("pandas").DataFrame({"rotary speed [rad/s]": self.speeds, "severity [-]": self.severity})


class Columns(Dict[str, List[float]]):
    """Lists by name, all of one length: of stations along a string."""
    units: dict[str, str] = {}

    def _asdict(self) -> dict[str, list[float]]:
        """The lists by name."""
        return dict(self)

    def frame(self) -> Any:
        """The lists as a pandas frame with units in the names of its columns."""
        return need("pandas").DataFrame({f"{name.replace('_', ' ')} [{self.units[name]}]": one
                                         for name, one in self.items()})


def by_field(cls: Any, rows: Iterable[Any]) -> dict[str, list[Any]]:
    """The fields of structs by name, a list each."""
    kept = list(rows)
    return {name: [row[name] for row in kept] for name in cls().keys()}


def frame_of(cls: Any, rows: Sequence[Any], index: dict[str, Sequence[Any]] | None = None) -> Any:
    """A pandas frame of structs, a row each, units in the names of its columns; columns of `index` come first."""
    names = [name for name, kind in cls._fields_ if name != "struct_size"
             and not name.rstrip("0123456789").endswith("reserved")
             and not hasattr(kind, "_length_") and not hasattr(kind, "contents")]
    table = {f"{name.replace('_', ' ')} [{cls.field_docs[name][0] or '-'}]": [getattr(row, name) for row in rows]
             for name in names}
    return need("pandas").DataFrame({**(index or {}), **table})
