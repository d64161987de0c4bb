"""One sample of a scene, from its standard normal numbers to the margins of its failures. Pickles, for workers."""
from __future__ import annotations

import hashlib
import importlib.util
import inspect
import math
import pathlib
import threading
import time as clock
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

from .._optional import need
from ..errors import Error
from ..remade import number_of
from ..scene import CannotSave, Scene, SceneError, loads
from ..scene.failure import KINDS, Failure
from . import statics
from .draw import CannotDraw, Draw
from .drawn_limits import DrawnLimits
from .limits import BESIDE, Course, Watch, margin_of
from .soft import SoftString

DONE, FAILED = 1, 2  #: of a sample: it has margins; it has a message instead


@dataclass
class Result:
    """The outcome of a sample."""
    number: int
    status: int                    #: DONE or FAILED
    margins: list[float]           #: of each failure; NaN where it FAILED
    demands: list[float]
    inputs: list[float]            #: scattered parameters (SI or factors); of fields and processes their means
    seconds: float                 #: of a processor
    message: str = ""


@dataclass(frozen=True)
class Own:
    """A function of Python as a limit state, by its file and name: function(look) -> margin, where look is an OwnLook.
    From a file, so that workers on other machines have it."""
    file: str
    name: str

    def load(self) -> Callable[[OwnLook], float]:
        """The function."""
        spec = importlib.util.spec_from_file_location("drillmbd_own_"
                                                      + hashlib.sha256(self.file.encode()).hexdigest()[:12], self.file)
        if spec is None or spec.loader is None:
            raise ImportError(f"{self.file} is no file of Python")
        module = importlib.util.module_from_spec(spec)
        spec.loader.exec_module(module)
        found = getattr(module, self.name, None)
        if not callable(found):
            raise ImportError(f"{self.file} has no function {self.name}")
        return found  # type: ignore[no-any-return]

    @property
    def source(self) -> str:
        """Its text, by which a study checks that it is the same."""
        return f"{pathlib.Path(self.file).read_text(encoding='utf-8')}\n:{self.name}"


@dataclass
class OwnLook:
    """Results of a run for limit states of the user's own."""
    scene: Scene
    sim: Any                       #: at the end of the run
    values: dict[str, Any]         #: of all that varies in this sample
    times: Any                     #: [s] of the looks
    outputs: dict[str, Any]       #: the scene's [[output]] by name, as arrays in time


def source_of(own: Any) -> str:
    """The text of an Own or of a function."""
    return own.source if isinstance(own, Own) else inspect.getsource(own)


def worst(found: Sequence[tuple[float, float]]) -> tuple[float, float]:
    """The pair with the least margin; one without a margin where there is any."""
    return next((one for one in found if math.isnan(one[0])), min(found))


def string_of(scene: Scene, part: str, made: Any) -> str:
    """The name of the string that a part of a failure belongs to; the first one for a drive of a joint or body."""
    key = {"bit": "string", "string": ""}.get(part, "part")
    calls = [arguments[0] for name, arguments in scene.model.calls if name == ("add_bit" if part == "bit"
                                                                               else "add_drive")]
    string = calls[number_of(made)].get(key) if key else made
    return next((name for name in scene.pipes if scene.names[name] == string), next(iter(scene.pipes), ""))


def _lacking(state: statics.State) -> dict[str, float]:
    """Parts of the demands that a static state lacks, by the name of the failure."""
    return {one.name: state.torque.get((string_of(state.scene, *next(iter(one.parts.items()))), one.kind), 0.0)
            for one in state.scene.failures if one.parts}


@dataclass
class SceneSample:
    """evaluate(number, z) -> Result, of a scene given as text."""
    text: str
    name: str = "scene"
    folder: str = "."
    own: Mapping[str, Any] = field(default_factory=dict)  #: functions or Own by the failure's name
    overrides: Mapping[str, Any] = field(default_factory=dict)  #: of the scene, in all samples
    given_question: str = ""  #: the question, instead of that of [variability]
    known: bool = False   #: only of failures that the question finds a demand of

    def __post_init__(self) -> None:
        self._draw: Draw | None = None
        self._soft = dict[int, SoftString]()
        self._course: Course | None = None
        self._limits: DrawnLimits | None = None

    def __getstate__(self) -> dict[str, Any]:
        return {**self.__dict__, "_draw": None, "_soft": {}, "_course": None, "_limits": None}

    @property
    def question(self) -> str:
        """torque-drag, static or run."""
        return self.given_question or self.draw.varies.question

    @property
    def quick(self) -> bool:
        """Samples take a millisecond: engines get several at a time."""
        return self.question == "torque-drag"

    @property
    def failures(self) -> list[Failure]:
        """Those with a margin in each sample."""
        found = self.draw.scene.failures
        return [one for one in found if self.question in KINDS[one.kind].questions] if self.known else found

    @property
    def soft(self) -> SoftString:
        """Made once in each thread, whose samples change it; forked processes have that of their parent."""
        thread = threading.get_ident()
        if thread not in self._soft:
            self._soft[thread] = SoftString(self.text, self.name, self.folder, self.overrides, self.draw,
                                            [one for one in self.failures if one.kind not in BESIDE])
        return self._soft[thread]

    @property
    def draw(self) -> Draw:
        """Made once in each process."""
        if self._draw is None:
            scene = loads(self.text, self.name, self.folder, self.overrides)
            self._draw = Draw(scene)
            if not scene.failures:
                raise CannotDraw(f"{self.name} has no [[failure]]: nothing can fail")
            self._refuse_others(scene.failures)
            self._refuse_other_strings(scene)
            missing = [one.name for one in scene.failures if one.kind == "own" and one.name not in self.own]
            if missing:
                raise CannotDraw(f"failure {missing[0]} is of the kind own: give its function (command: --own "
                                 f"{missing[0]}=FILE.py:NAME)")
        return self._draw

    @property
    def limits(self) -> DrawnLimits:
        """Limits that vary. Made once in each process."""
        if self._limits is None:
            self._limits = DrawnLimits(self.draw, lambda overrides: loads(self.text, self.name, self.folder,
                                                                          {**self.overrides, **overrides,
                                                                           "variability": None}))
        return self._limits

    def _refuse_others(self, failures: list[Failure]) -> None:
        """Failures that the question of the command line says nothing about."""
        for one in failures:
            if self.known or not self.given_question:
                continue
            if self.given_question not in KINDS[one.kind].questions:
                raise CannotDraw(f"failure {one.name} ({one.kind}): the question {self.given_question} says nothing "
                                 "about it; ask --question "
                                 f"{' or '.join(KINDS[one.kind].questions)}, or auto, or take it out")
            if self.given_question != "run" and one.values.get("from", 0.0) > 0.0:
                raise CannotDraw(f"failure {one.name}: from = {one.values['from']:g} s is for runs in time, and the "
                                 f"question is {self.given_question}")

    def _refuse_other_strings(self, scene: Scene) -> None:
        """Failures of another string than the first one, which is the only one that torque and drag computes."""
        if self.question != "torque-drag":
            return
        first = next(iter(scene.pipes), "")
        for one in self.failures:
            others = [found for part, made in one.parts.items() if (found := string_of(scene, part, made)) != first]
            if others:
                raise CannotDraw(f"failure {one.name} ({one.kind}) is about the string {others[0]}: torque and drag "
                                 f"computes the first string only, {first}; ask --question static or run, or take the "
                                 "failure out")

    @property
    def dimension(self) -> int:
        """Number of standard normal numbers of a sample."""
        return self.draw.dimension

    @property
    def names(self) -> list[str]:
        """Of the failures."""
        return [one.name for one in self.failures]

    @property
    def inputs(self) -> list[str]:
        """Of the uncertain parameters."""
        return self.draw.varies.names

    def describe(self) -> dict[str, str]:
        """All that the results depend on, for the study file."""
        from ..scene import saves
        scene = self.draw.scene
        known = {"scene": saves(scene, False), "question": self.question}
        return {**known, **{f"function {name}": source_of(function) for name, function in sorted(self.own.items())}}

    def __call__(self, number: int, z: Any) -> Result:
        """A sample that the library refuses, or that does not converge, is FAILED with its message; never an
        exception."""
        started = clock.thread_time()
        return self._result(number, self.draw.values(z), started)

    def many(self, tasks: Sequence[tuple[int, Any]]) -> list[Result]:
        """Several samples, of each the same as alone."""
        started = clock.thread_time()
        drawn = self.draw.values_of([z for _, z in tasks])
        each = (clock.thread_time() - started) / max(1, len(tasks))
        return [self._result(number, values, clock.thread_time() - each) for (number, _), values in zip(tasks, drawn)]

    def _result(self, number: int, values: dict[str, Any], started: float) -> Result:
        count = len(self.names)
        inputs = [self.draw.mean(name, values[name]) for name in self.inputs]
        try:
            found = self._margins(values)
            margins, demands, status, message = [a for a, _ in found], [b for _, b in found], DONE, ""
        except (Error, SceneError, CannotSave, ArithmeticError, ValueError) as error:
            margins, demands, status, message = ([math.nan] * count, [math.nan] * count, FAILED,
                                                 f"{type(error).__name__}: {error}")
        return Result(number, status, margins, demands, inputs, clock.thread_time() - started, message)

    def _margins(self, values: dict[str, Any]) -> list[tuple[float, float]]:
        if self.question == "torque-drag" and not any(one.kind in BESIDE for one in self.failures):
            return self.soft.margins(values, self.limits.of(self.failures, values))
        scene = loads(self.text, self.name, self.folder, {**self.overrides, **self.draw.overrides(values)})
        if self.question == "torque-drag":
            failures = self.limits.of(self.failures, values)
            quick = [one for one in failures if one.kind not in BESIDE]
            known = dict(zip((one.name for one in quick), self.soft.margins(values, quick)))
            return [known[one.name] if one.name in known else self._beside(one, scene, None, values, None, None)
                    for one in failures]
        if self.question == "static":
            return self._static(scene, values)
        end = scene.run.get("end", 0.0)
        look = self.draw.varies.settings.get("look") or scene.results.get("interval") or scene.run.get("step") or end
        with scene.new_sim() as sim:
            if scene.run.get("static"):
                sim.static(**scene.fields_of("static"))
            return self._looked(scene, sim, values, end, look, {})

    def _static(self, scene: Scene, values: dict[str, Any]) -> list[tuple[float, float]]:
        """The worst of the stiff string pushed in, pulled out and rotated, with the load of the bit."""
        found = []
        for state in statics.states(scene):
            with statics.at_rest(state) as sim:
                found.append(self._looked(state.scene, sim, values, 0.0, 1.0, _lacking(state)))
        return [worst(one) for one in zip(*found)]

    def _looked(self, scene: Scene, sim: Any, values: dict[str, Any], end: float, look: float, more: Mapping[str, float]
                ) -> list[tuple[float, float]]:
        """Margins and demands of a sim from now to `end` [s]; more: of demands, the parts that the sim lacks, by the
        failure's name."""
        watch = Watch(scene, sim, scene.failures, int(end / look) + 2)
        recorder = sim.recorder([(place, quantity, name) for name, place, quantity in scene.outputs],
                                int(end / look) + 4) \
            if self.own and scene.outputs else None
        self._run(scene, sim, end, look, watch, recorder)
        found = watch.margins(more)
        for one in scene.failures:
            if one.kind in BESIDE:
                found[one.name] = self._beside(one, scene, sim, values, watch, recorder)
        return [found[one.name] for one in self.failures]

    @staticmethod
    def _run(scene: Scene, sim: Any, end: float, look: float, watch: Watch, recorder: Any) -> None:
        """Looks at the beginning, after each `look` [s] (a whole number of steps) and at the end."""
        def take() -> None:
            watch.look()
            if recorder is not None:
                recorder.take()
        watch.count()
        take()
        step = scene.run.get("step")
        if step:
            count, each = max(0, round(end / step)), max(1, round(look / step))
            stretch = 1 if watch.counters else each
            for number in range(0, count, each):
                last = min(number + each, count)
                for begin in range(number, last, stretch):
                    sim.steps(step, min(stretch, last - begin))
                    watch.count()
                take()
            return
        count = math.ceil(end / look - 1e-9) if end > 0.0 else 0
        for number in range(1, count + 1):
            sim.run_noting(min(number * look, end), counters=list(watch.counters.values()))
            take()

    def _beside(self, one: Failure, scene: Scene, sim: Any, values: dict[str, Any], watch: Any,
                recorder: Any) -> tuple[float, float]:
        """Margin and demand of a kind that needs more than signals."""
        if one.kind == "own":
            return self._own(one.name, one.limit, scene, sim, values, watch, recorder)
        if self._course is None:
            self._course = Course(self.draw.scene)
        demand = self._course.off(scene)
        return margin_of(one, demand), demand

    def _own(self, name: str, limit: float, scene: Scene, sim: Any, values: dict[str, Any], watch: Watch,
             recorder: Any) -> tuple[float, float]:
        numpy, given = need("numpy"), self.own[name]
        function = given.load() if isinstance(given, Own) else given
        table = numpy.array(recorder.table) if recorder is not None else numpy.zeros((len(watch.times), 1))
        outputs = {output: table[:, 1 + i]
                   for i, (output, _, _) in enumerate(scene.outputs)} if recorder is not None else {}
        try:
            found = float(function(OwnLook(scene, sim, values, numpy.array(watch.times), outputs)))
        except Exception as error:  # anything may be wrong with it; the sample is reported as failed
            raise ValueError(f"{name}: {type(error).__name__}: {error}") from error
        if math.isnan(found):
            raise ValueError(f"{name}: the margin is not a number")
        return found - limit, found
