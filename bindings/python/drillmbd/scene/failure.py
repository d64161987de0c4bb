"""[[failure]] of a scene file: failures, each a kind with its limit. The margins are found by
drillmbd.probability.limits."""
from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

from .. import enums
from .._structs import Id
from . import units
from .fields import Field
from .lines import Path
from .problems import meant

if TYPE_CHECKING:
    from .load import Loader

QUESTIONS = ("run", "static", "torque-drag", "auto")  #: of [variability]


@dataclass(frozen=True)
class Key:
    """A further key of a kind of failure."""
    unit: str
    default: float | str | None = None  #: a text names a key of [limits]; None: it must be given
    positive: bool = False              #: must be > 0, not >= 0


@dataclass(frozen=True)
class Kind:
    """A limit state. Other modules use a kind through this registry only; the functions that find its demand from a
    run, a static state or torque and drag stand beside it by the same name in drillmbd.probability.limits."""
    unit: str                           #: of demand and limit
    about: str
    default: float | str | None = None  #: of the limit; a text names a key of [limits]
    needs: tuple[str, ...] = ()         #: parts: bit, head (drive of rotation), feed, string
    keys: dict[str, Key] = field(default_factory=dict)
    questions: tuple[str, ...] = ("torque-drag", "static", "run")  #: that find its demand
    low: bool = False                   #: fails where the demand is below the limit
    free: bool = False                  #: the limit may be 0 or negative
    source: str = ""                    #: of the default, or the reason why there is none


IN_TIME = ("run",)
KINDS: dict[str, Kind] = {
    "bit-stuck": Kind("s", "longest time that the bit does not turn while the rig does", None, ("bit", "head"),
                      {"speed": Key("rad/s", 0.1)},
                      IN_TIME),
    "rig-torque": Kind("N m", "largest torque of the rotation drive", "torque", ("head",)),
    "rig-push": Kind("N", "largest push of the feed drive", "push", ("feed",)),
    "rig-pull": Kind("N", "largest pull of the feed drive", "pull", ("feed",)),
    "lock-up": Kind("-",
                    "share of the push at the rig that arrives as load of the bit, means over the time; fails below",
                    0.1,
                    ("bit", "feed"), low=True),
    "helical-buckling": Kind("-", "largest share of the load of helical buckling", 1.0, ("string",)),
    "stress": Kind("-", "largest equivalent stress over the strength", 1.0, ("string",),
                   {"strength": Key("Pa", "yield_stress", True)}),
    "connection-torque": Kind("N m", "largest torque that tightens right-hand threads, as turning towards +x does",
                              "make_up_torque", ("string",),
                              source="make-up torque of the threads: threads that are turned beyond it in the hole are "
                                     "made up further or yield (API RP 7G, "
                              "which computes it as the torque that stresses the weaker of pin and box to 60 % of the "
                              "minimum yield strength)"),
    "back-off": Kind("N m", "largest torque that loosens right-hand threads", None, ("string",), {}, ("static", "run")),
    "fatigue": Kind("-", "damage of a pass (Miner's sum)", 1.0, ("string",),
                    {"curve_stress": Key("Pa", None, True), "curve_cycles": Key("-", 1e6, True),
                     "slope": Key("-", None, True),
                     "endurance": Key("Pa", 0.0), "concentration": Key("-", 1.0)}, IN_TIME),
    "lateral-acceleration": Kind("m/s2", "largest acceleration across the axis", None, ("string",), {}, IN_TIME),
    "bit-off-bottom": Kind("s", "longest time that the bit's weight is no more than `load`", None, ("bit",),
                           {"load": Key("N", 0.0)}, IN_TIME),
    "wall-pressure": Kind("Pa", "largest wall force per length over the `width` that bears it", 8.7e6, ("string",),
                          {"width": Key("m", None, True)},
                          source="uniaxial compressive strength of soft coal, 10 MPa times the strength coefficient f "
                                 "= 0.87 of Protodyakonov (soft class of "
                          "three coal mines, Processes 2025, 13(7), 2195, doi:10.3390/pr13072195); give that of your "
                          "seam"),
    "stick-slip": Kind("-", "(largest - smallest spin of the bit)/(2 mean of its magnitude)", 1.0, ("bit",), {},
                       IN_TIME),
    "jamming": Kind("N",
                    "largest force on rods held by collapsed coal or cuttings that the rig overcomes, by pull or by "
                    "torque at the `diameter` "
                    "that is held, beside the friction of the hole; fails below the holding force, which is the limit",
                    None, ("string",),
                    {"pull": Key("N", "pull", True), "torque": Key("N m", "torque", True),
                     "diameter": Key("m", None, True)}, ("torque-drag",), low=True,
                    source="no default: no public measurement of the force with which collapsed coal or cuttings hold "
                           "rods was found"),
    "leaves-seam": Kind("m",
                        "largest vertical distance of the hole, as far as the string reaches, from the course that the "
                        "scene gives, where the "
                        "survey varies; the limit is the coal above or below that course",
                        source="no default: the thickness of the seam is that of your mine"),
    "own": Kind("-", "a function of Python that is given to the study by the failure's name", 0.0, (), {},
                ("static", "run"), free=True)}


@dataclass
class Failure:
    """A limit state."""
    name: str
    kind: str
    limit: float                #: in the kind's unit
    values: dict[str, float]    #: further keys of the kind, and from, to [s]
    parts: dict[str, Id]        #: bit, head, feed, string
    names: dict[str, str]       #: of these parts
    #: the limit is a default number of its kind, which has a source
    assumed: bool = field(default=False, compare=False)


class Reader:
    """Reads the tables with the problems of a loader."""

    def __init__(self, loader: Loader, limits: dict[str, float]) -> None:
        self.loader, self.problems, self.limits = loader, loader.problems, limits
        self.names: set[str] = set()

    def failures(self) -> list[Failure]:
        """All of the scene."""
        found = [self._failure(path, number, table)
                 for number, (path, table) in enumerate(self.loader.parts("failure"))]
        return [one for one in found if one is not None]

    def _failure(self, path: Path, number: int, table: dict[str, Any]) -> Failure | None:
        word = table.get("kind")
        if not isinstance(word, str) or word not in KINDS:
            self.problems.add(path + ("kind",) if "kind" in table else path, word,
                              "must be one of the kinds" + meant(str(word), KINDS) if "kind" in table else
                              f"must have a kind; possible are {', '.join(KINDS)}")
            return None
        name = table.get("name", word)
        if not isinstance(name, str) or not name:
            self.problems.add(path + ("name",), name, "must be a text that is not empty")
        elif name in self.names:
            self.problems.add(path + ("name",), name, "names a failure already; give each a name of its own")
        self.names.add(str(name))
        kind, needs = KINDS[word], KINDS[word].needs
        self._check_question(path, word, kind)
        keys = {"limit": Field("limit", "quantity", kind.unit), "from": Field("from", "quantity", "s"),
                "to": Field("to", "quantity", "s"),
                **{key: Field(key, "quantity", one.unit) for key, one in kind.keys.items()}}
        values = self.loader.read(path, table, keys, ("name", "kind", *needs))
        self._defaults(path, table, kind, word, values)
        parts, names = self._parts(path, table, needs)
        if "limit" not in values or len(parts) < len(needs):
            return None
        return Failure(str(name), word, values.pop("limit"), values, parts, names,
                       "limit" not in table and isinstance(kind.default, float) and bool(kind.source))

    def _check_question(self, path: Path, word: str, kind: Kind) -> None:
        """The question of [variability] must find the demand."""
        if not self.loader.content.get("variability"):
            return  # as in a sample, in which nothing varies any more
        question = self.loader.table(("variability",)).get("question", "run")
        if question in QUESTIONS and question != "auto" and question not in kind.questions:
            self.problems.add(path + ("kind",), word,
                              f"needs {_needed_questions(kind.questions)}; the question is {question}")

    def _defaults(self, path: Path, table: dict[str, Any], kind: Kind, word: str, values: dict[str, float]) -> None:
        for key, one in kind.keys.items():
            default = self.limits.get(one.default) if isinstance(one.default, str) else one.default
            if key not in table and default is not None:
                values[key] = default
            elif key not in table:
                self.problems.add(path, None, f"{word} must have a {key} [{one.unit}]")
            elif key in values and (values[key] < 0.0 or (one.positive and values[key] == 0.0)):
                self.problems.add(path + (key,), table[key], "must be > 0" if one.positive else "must be >= 0")
        limit = self.limits.get(kind.default) if isinstance(kind.default, str) else kind.default
        if "limit" not in table and limit is not None:
            values["limit"] = limit
        elif "limit" not in table:
            also = f", or [limits] {kind.default}" if isinstance(kind.default, str) else ""
            self.problems.add(path, None, f"{word} must have a limit [{kind.unit}]{also}"
                              + (f" ({kind.source})" if kind.source else ""))
        elif "limit" in values and not kind.free and not values["limit"] > 0.0:
            self.problems.add(path + ("limit",), table["limit"], "must be > 0")
        if "from" in values and "to" in values and not values["to"] > values["from"]:
            self.problems.add(path + ("to",), table["to"], "must be > from")
        self._within_run(path, table, values)

    def _within_run(self, path: Path, table: dict[str, Any], values: dict[str, float]) -> None:
        """A failure that nothing is looked at for would have no margin in any sample."""
        if self.loader.table(("variability",)).get("question") in ("static", "torque-drag"):
            end, about = 0.0, "the time of a static state; leave it out"
        else:
            end, about = self._end(), "the end of the run"
        if values.get("from", -math.inf) > end:
            self.problems.add(path + ("from",), table["from"], f"must be <= {end:g} s, {about}")
        if values.get("to", math.inf) < 0.0:
            self.problems.add(path + ("to",), table["to"], "must be >= 0 s, the beginning of the run")

    def _end(self) -> float:
        """[s] of the run; infinite where the scene does not say."""
        try:
            return units.parse(self.loader.table(("run",))["end"], "s")
        except (KeyError, units.UnitError):
            return math.inf

    def _parts(self, path: Path, table: dict[str, Any], needs: tuple[str, ...]) -> tuple[dict[str, Id], dict[str, str]]:
        """The parts that a kind is about: as written, or the only one that fits."""
        parts, names = dict[str, Id](), dict[str, str]()
        for need in needs:
            if need in table:
                name = table[need]
                known = self._fitting(need)
                if not isinstance(name, str) or name not in known:
                    self.problems.add(path + (need,), name, f"must name {_called(need)}" + meant(str(name), known))
                    continue
            else:
                known = self._fitting(need)
                if not known or (len(known) > 1 and need != "string"):
                    self.problems.add(path, None, f"must name {_called(need)}: {need} = ..." + meant("", known))
                    continue
                name = known[0]
            made = self.loader.names.get(name)
            if made is not None:
                parts[need], names[need] = made, name
        return parts, names

    def _fitting(self, need: str) -> list[str]:
        if need in ("bit", "string"):
            return [self.loader.name(need, number, table) for number, (_, table) in enumerate(self.loader.parts(need))]
        wanted = int(enums.Component.RX if need == "head" else enums.Component.X)
        from .fields import DEFINITIONS, fields_of
        component = fields_of(DEFINITIONS["drive"])["component"]
        return [self.loader.name("drive", number, table) for number, (_, table) in enumerate(self.loader.parts("drive"))
                if self.loader.word(component, table.get("component"), 0) == wanted]


def _needed_questions(questions: tuple[str, ...]) -> str:
    words = {"run": 'a run in time: [variability] question = "run"', "static": 'question = "static"',
             "torque-drag": 'question = "torque-drag"'}
    return " or ".join(words[one] for one in reversed(questions))


def _called(need: str) -> str:
    return {"bit": "a bit", "string": "a string", "head": "a drive of rotation (rx)",
            "feed": "a drive along the string (x)"}[need]


def unit_of(loader: Loader, path: Path) -> str | None:
    """The unit of a number of a failure at a path of the scene, as ("failure", 0, "limit"); None where there is
    none."""
    number = path[1] if len(path) == 3 and isinstance(path[1], int) else 0
    found = loader.parts("failure")
    kind = KINDS.get(str(found[number][1].get("kind"))) if number < len(found) else None
    if kind is None or path[-1] == "limit":
        return None if kind is None else kind.unit
    return kind.keys[str(path[-1])].unit if path[-1] in kind.keys else None


def table_of(one: Failure) -> dict[str, Any]:
    """The keys of a failure as they are written."""
    kind = KINDS[one.kind]
    known = {"from": "s", "to": "s", **{key: one.unit for key, one in kind.keys.items()}}
    return {"name": one.name, "kind": one.kind, "limit": units.text(one.limit, kind.unit), **one.names,
            **{key: units.text(value, known[key]) for key, value in one.values.items()}}


def schema(many: Any, table: Any, quantity: Any, name: Any) -> dict[str, Any]:
    """The part of the JSON schema, by functions of scene.schema."""
    keys = {key for kind in KINDS.values() for key in kind.keys} | {"limit", "from", "to"}
    parts = {one for kind in KINDS.values() for one in kind.needs}
    about = "; ".join(f"{word} [{kind.unit}]: {kind.about}" + (f" (limit: {kind.source})" if kind.source else "")
                      for word, kind in KINDS.items())
    return many(table({}, ("kind",), name=name,  # type: ignore[no-any-return]
                      kind={"enum": list(KINDS), "description": about},
                      **{key: quantity for key in sorted(keys)}, **{key: name for key in sorted(parts)}))
