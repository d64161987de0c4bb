"""The question auto: torque and drag of all samples, and runs in time only of those near a limit and of a random part
of the others.

A sample whose torque and drag leave less than NEAR of a limit, on either side, is run; of the others each with the
probability part_of, by a random number of its own, so that each represents 1/part_of samples. With A the failures among
the samples near a limit and, among the others, those that torque and drag predict, and with B+ and B- the shares of the
others that fail in time against the prediction and that do not fail against it,

    P = A + B+ - B-                                                                (difference estimator, Cochran 1977,
    section 12)

is unbiased although torque and drag is a simpler model. Failures that only a run shows are predicted in no sample: B+
alone finds them. Percentiles of the demands are those of the runs by these weights (demands.weighted_percentile)."""
from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

from .._optional import need
from ..results import CommandOutput
from ..errors import Usage
from ..scene.failure import KINDS
from .results import ANY, StudyResults, StudySettings
from .draw import CannotDraw
from .estimates import Estimate, clopper_pearson
from .sampling import Points, stream
from .sample import SceneSample

NEAR = 0.5  #: of a limit: a margin of torque and drag below it is not trusted
FAR = 0.1   #: of the samples that are not near a limit are run,
LEAST = 100  #: or as many as make so many of all samples: fewer would say little about the others


def part_of(samples: int) -> float:
    """The probability with which a sample that is not near a limit is run."""
    return min(1.0, max(FAR, LEAST / samples))


def chosen(seed: int, number: int, part: float) -> bool:
    """Whether a sample that is not near a limit is run; one that is chosen for a small part is chosen for a larger one
    too."""
    return bool(stream(seed, (1 << 61) + (1 << 60) + number).random() < part)


@dataclass
class Stage:
    """Samples of both stages: predictions of torque and drag, which of them are near a limit, which are run, which fail
    in time."""
    predicted: Any
    near: Any
    chosen: Any   #: to be run
    ran: Any      #: of those, with a margin
    failed: Any   #: of those
    part: float   #: of the samples that are not near a limit

    @property
    def lost(self) -> int:
        """Chosen to be run, and without a margin."""
        return int((self.chosen & ~self.ran).sum())

    def estimate(self, confidence: float) -> Estimate:
        """P with the interval that holds for its three parts together (Bonferroni): counts of a part each, by Clopper
        and Pearson. Lost runs are left out of P; for the interval each of them decides against it."""
        numpy, samples = need("numpy"), len(self.predicted)
        near, far = self.near & self.ran, ~self.near & self.ran
        parts = 1.0 - (1.0 - confidence) / 3.0
        certain = int((near & self.failed).sum() + (~self.near & self.predicted).sum())
        missing = int((self.near & ~self.ran).sum())
        low, high = clopper_pearson(certain, samples, parts)[0], clopper_pearson(certain + missing, samples, parts)[1]
        value = certain / samples
        for sign, group in ((1.0, ~self.near & ~self.predicted), (-1.0, ~self.near & self.predicted)):
            count, looked = int(group.sum()), int((group & far).sum())
            wrong = int((group & far & (self.failed != self.predicted)).sum())
            gone = int((group & ~self.near & self.chosen & ~self.ran).sum())
            most = clopper_pearson(wrong + gone, looked + gone, parts)[1] if looked + gone else 1.0
            share = most * _upper_share(count, samples, parts)
            value += sign * (wrong / looked if looked else 0.0) * count / samples
            low, high = (low, high + share) if sign > 0.0 else (low - share, high)
        run = int(self.ran.sum())
        # torque and drag alone is no estimate
        value = float(numpy.clip(value, 0.0, 1.0)) if run or not self.lost else math.nan
        return Estimate(value, max(0.0, low), min(1.0, high), confidence, "auto", samples,
                        int((self.ran & self.failed).sum()), self.lost,
                        f"difference estimator: torque and drag of {samples} samples, runs of {run}, {int(near.sum())} "
                        "of them near a limit with the "
                        f"weight 1 and {int(far.sum())} others with the weight {1.0 / self.part:.4g}",
                        {"runs": run, "near": int(self.near.sum()), "weight_of_others": 1.0 / self.part})


def _upper_share(count: int, samples: int, parts: float) -> float:
    """Upper end of the share of a group."""
    return clopper_pearson(count, samples, parts)[1] if count else 0.0


class Auto(StudyResults):
    """Both stages."""

    def __init__(self, settings: StudySettings, output: CommandOutput) -> None:
        super().__init__(settings, output)
        self.question = "auto"
        if settings.sampling != "monte-carlo" or settings.rule is not None or settings.options.surrogate:
            raise Usage("--question auto is a Monte Carlo study: leave --indices, --until, --surrogate and other "
                        "methods out")
        whole = settings.sample
        self.quick = SceneSample(whole.text, whole.name, whole.folder, whole.own, whole.overrides, "torque-drag", True)

    def compute(self) -> int:
        settings, whole = self.settings, self.sample
        if not self.quick.names:
            raise CannotDraw("no failure of the scene has a demand of torque and drag: ask --question run")
        for text in self.quick.soft.notes():
            self.output.note_text(text)
        dynamic = [one.name for one in settings.failures if "torque-drag" not in KINDS[one.kind].questions]
        self.output.say("question auto: torque and drag of all samples; runs in time where they leave less than "
                        f"{100 * NEAR:g} % of a limit, and of "
                        f"{100 * part_of(settings.samples):.3g} % of the others"
                        + (f"; only runs show {', '.join(dynamic)}" if dynamic else ""))
        points = Points("monte-carlo", settings.seed, whole.dimension, settings.samples)
        soft = self.study(self.quick, "study_torque_drag.h5")
        study = None
        try:
            quick = soft.run(range(settings.samples), points.z)
            study = self.study(whole, "study.h5")
            self._runs(study, points, quick)
        except KeyboardInterrupt:
            self.stopped(study or soft)
        finally:
            for one in (soft, study):
                if one is not None:
                    self.close(one)
        seconds = math.fsum(one.seconds for one in soft.results.values())
        self.output.say(f"torque and drag: {soft.evaluated} samples computed, "
                        f"{seconds / max(1, len(soft.results)):.3g} s of a processor each")
        self.output.summary.update(torque_drag_samples=len(soft.results), seconds_of_torque_drag=seconds)
        return self.finish(study or soft)

    def _runs(self, study: Any, points: Points, quick: list[Any]) -> None:
        numpy, settings = need("numpy"), self.settings
        scale = {one.name: abs(one.limit) or 1.0 for one in settings.failures}
        margins = numpy.array([one.margins for one in quick]) / numpy.array([scale[name] for name in self.quick.names])
        least = margins.min(axis=1)  # NaN of a sample without torque and drag: run
        near = ~(abs(margins).min(axis=1) > NEAR)
        run = [number for number in range(settings.samples) if near[number]
               or chosen(settings.seed, number, part_of(settings.samples))]
        results = study.run(run, points.z)
        found = numpy.full((settings.samples, len(self.sample.names)), math.nan)
        chosen_to_run = numpy.zeros(settings.samples, bool)
        chosen_to_run[run] = True
        for one in results:
            found[one.number] = one.margins
        for i, name in enumerate(self.sample.names):
            soft = (margins[:, self.quick.names.index(name)] if name in self.quick.names
                    else numpy.full(settings.samples, math.inf))
            self._report_stages(name, soft, near, chosen_to_run, found[:, i])
        self._report_stages(ANY, least, near, chosen_to_run, (found / numpy.array(settings.scales())).min(axis=1))
        self._compare(margins, found, scale)
        if results:
            part = part_of(settings.samples)
            self.say_demands(results, numpy.array([1.0 if near[one.number] or part >= 1.0 else 1.0 / part
                                                   for one in results]))
        self.table(results)

    def _report_stages(self, name: str, soft: Any, near: Any, chosen_to_run: Any, found: Any) -> None:
        numpy = need("numpy")
        ran = ~numpy.isnan(found)
        stage = Stage(soft <= 0.0, near, chosen_to_run, ran, ran & (numpy.nan_to_num(found, nan=1.0) <= 0.0),
                      part_of(self.settings.samples))
        self.report(name, stage.estimate(self.settings.confidence))

    def _compare(self, margins: Any, found: Any, scale: dict[str, float]) -> None:
        """Differences between torque and drag and the runs, over the limit."""
        numpy = need("numpy")
        for i, name in enumerate(self.quick.names):
            column = found[:, self.sample.names.index(name)] / scale[name]
            both = numpy.isfinite(column) & numpy.isfinite(margins[:, i])
            if not both.any():
                continue
            off = column[both] - margins[both, i]
            other = int(((column[both] <= 0.0) != (margins[both, i] <= 0.0)).sum())
            self.output.summary.setdefault("torque_drag_against_runs", {})[name] = {
                "samples": int(both.sum()), "mean_of_limit": float(off.mean()),
                "largest_of_limit": float(abs(off).max()), "other_decisions": other}
            self.output.say(f"{name}: in {int(both.sum())} samples that have both, the margin in time is larger than "
                            "that of torque and drag by "
                            f"{100 * off.mean():+.3g} % of the limit in the mean, {100 * abs(off).max():.3g} % at "
                            f"most; {other} decisions differ")
