"""A scene: a compiled model with the names of its parts, and the settings of commands."""
from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Any

from .._structs import Excitation, Order, Output, Place
from ..enums import EXCITATION_ECCENTRICITY
from ..model import Model, map_ids
from ..outputs import output_of
from ..sim import Sim
from .divide import Divided
from .failure import Failure
from .fields import DEFINITIONS
from .problems import Problem
from .source import Source
from .variability import Variability

# In the order in which they are described; NAMED: their names go to the library as they are written.
PARTS = ("string", "body", "stabiliser", "bit", "joint", "coupling", "drive", "load", "spring", "stuck", "input",
         "event")
NAMED = ("string", "body", "stabiliser", "bit", "joint", "coupling", "drive", "load", "spring", "stuck", "input")
SINGLE = ("environment", "hole")
SLIPS = ("slip_axial", "slip_rotation")
ANALYSES = ("static", "modes", "response", "speeds", "buckling", "fatigue")


@dataclass
class Scene:
    """The content of a scene file."""
    title: str
    model: Model                    #: compiled
    names: dict[str, Any]           #: ids of parts and time functions
    pipes: dict[str, int]           #: number of pipes of each string
    time_function_units: dict[str, str] = field(default_factory=dict)
    sim: dict[str, Any] = field(default_factory=dict)      #: fields of SimOptions
    run: dict[str, Any] = field(default_factory=dict)      #: end [s], step [s], static
    results: dict[str, Any] = field(default_factory=dict)   #: interval [s], vtk_interval [s], units
    limits: dict[str, float] = field(default_factory=dict)  #: torque [N m], push [N], pull [N], yield_stress [Pa]
    outputs: list[tuple[str, Place | None, int]] = field(default_factory=list)  #: name, place, quantity
    output_units: list[str] = field(default_factory=list)  #: of each output, SI
    analyses: dict[str, dict[str, Any]] = field(default_factory=dict)  #: fields of their options, by name
    variability: Variability | None = None  #: what varies
    failures: list[Failure] = field(default_factory=list)  #: what counts as a failure
    remarks: list[Problem] = field(default_factory=list)   #: what was assumed of the values of the file
    source: Source | None = None   #: the text of the file
    #: time functions that the file gives as a value in the place of a name
    inline: set[str] = field(default_factory=set)
    #: read again with changes by key
    changed: Callable[[Mapping[str, Any]], Scene] | None = field(default=None, compare=False, repr=False)
    #: pipes for which the file gives no elements and one does not suffice
    divided: list[Divided] = field(default_factory=list)

    #: of the analyses of its sims, for a terminal
    progress: Callable[[float], Any] | None = field(default=None, compare=False)

    def new_sim(self) -> Sim:
        """A sim with the options of the scene."""
        made = self.model.sim(**self.sim)
        if self.progress is not None:
            made.on_progress = self.progress
        return made

    def fields_of(self, analysis: str) -> dict[str, Any]:
        """The fields of the options of an analysis."""
        return {key: value for key, value in self.analyses.get(analysis, {}).items()
                if key not in ("excitation", "output") and not (analysis == "speeds" and key == "order")}

    def effective(self, analysis: str) -> dict[str, Any]:
        """The table of an analysis with the values that it takes from other tables."""
        values = dict(self.analyses.get(analysis, {}))
        if analysis == "fatigue" and "stress_range" not in values and "yield_stress" in self.limits:
            values["stress_range"] = 2.0 * values.get("concentration", 1.0) * self.limits["yield_stress"]
        if analysis == "buckling":  # the equilibrium of [static] is one with this friction only
            values = {**{key: value for key, value in self.analyses.get("static", {}).items() if key in SLIPS},
                      **values}
        if analysis in ("response", "speeds") and analysis in self.analyses:
            from ..rotating import options_of
            values = {**values, **options_of(self, analysis)}
        return values

    def excitations(self) -> list[Excitation]:
        """Of the response."""
        return [Excitation(**one) for one in self.analyses["response"]["excitation"]]

    def response_outputs(self, analysis: str) -> list[Output]:
        """Of the response or of the speeds."""
        return [output_of((one.get("place"), one["quantity"])) for one in self.analyses[analysis]["output"]]

    def output_names(self, analysis: str) -> list[str]:
        """Names of the outputs with their units."""
        return [f"{one['name']} [{one['unit']}]" for one in self.analyses[analysis]["output"]]

    def output_heads(self) -> list[str]:
        """Names of the outputs with their units in SI, at the end; a unit in the name is left out."""
        return [f"{name[:name.rindex('[')].rstrip() if name.endswith(']') and '[' in name else name} [{unit}]"
                for (name, _, _), unit in zip(self.outputs, self.output_units)]

    def orders(self) -> list[Order]:
        """Of the speeds."""
        found = []
        for one in self.analyses["speeds"]["order"]:
            values = {key: value for key, value in one.items() if key != "order"}
            values.setdefault("kind", EXCITATION_ECCENTRICITY)
            found.append(Order(order=one["order"], excitation=Excitation(**values)))
        return found

    def same_as(self, other: Scene) -> bool:
        """Whether both say the same."""
        def filled(struct: str, values: dict[str, Any]) -> dict[str, Any]:
            """With the defaults that are numbers."""
            usual = DEFINITIONS[struct]().describe(every=True)
            return {**{key: value for key, value in usual.items() if isinstance(value, (int, float, list))}, **values}

        def settings(scene: Scene) -> Any:
            outputs = [(name, place and (place.part.index, place.pipe, place.fraction), quantity)
                        for name, place, quantity in scene.outputs]
            analyses = {name: filled(name, scene.effective(name)) for name in ANALYSES if name in scene.analyses
                        or name in ("static", "modes")}
            for name, key in (("response", "excitation"), ("speeds", "order")):
                if name in analyses:
                    kind = {"kind": int(EXCITATION_ECCENTRICITY)} if key == "order" else {}
                    analyses[name][key] = [filled("response excitation", {**kind, **one})
                                           for one in analyses[name][key]]
            analyses = map_ids(analyses, lambda part: (part.index, bool(part)))
            failures = map_ids([vars(one) for one in scene.failures], lambda part: (part.index, bool(part)))
            return (scene.title, filled("sim", scene.sim), {"static": 0, **scene.run}, scene.results, outputs,
                    scene.pipes, analyses, scene.limits,
                    scene.variability, failures)
        return settings(self) == settings(other) and self.model.same_scene(other.model)
