"""The result of a study: probabilities with intervals, demands, rank correlations, cost; on the terminal, in
summary.json, as tables."""
from __future__ import annotations

import argparse
import math
import os
import sys
import time as clock
from dataclasses import replace
from typing import Any

from .._optional import need
from ..results import CommandOutput
from ..errors import Usage
from . import engines
from .assessed import Assessed
from ..scene.failure import KINDS
from .demands import Demand, amount, demand_of
from .estimates import Estimate, Indices, Subset, Surrogate, counted, effective, plan, sobol_indices
from .sampling import Points
from .sample import FAILED, Result, SceneSample
from .study import Progress, Study, StudyFile, usable
from .ticking import ticking
from .until import MOST, Rule, following, looks, rule, spent

ANY = "any failure"
MOST_SAMPLES = 10_000_000
LEFT_OUT = {"torque-drag": "by torque and drag of a soft string: pulled out, pushed in and rotated with the load of "
                           "the bit; dynamics and bending within the "
                           "clearance of the hole are left out",
            "static": "by static states of the stiff string: pushed in, pulled out and rotated with the load of the "
                      "bit; dynamics are left out",
            "run": "by a run in time of each sample, whose largest and smallest values are those of regular looks "
                   "([variability] look)"}


class StudySettings:
    """Settings of a study, of the command line and the scene."""

    def __init__(self, sample: SceneSample, options: argparse.Namespace) -> None:
        scene, varies = sample.draw.scene, sample.draw.varies
        known = varies.settings
        self.sample, self.options, self.failures = sample, options, sample.failures
        self.method = options.method or varies.method
        self.seed = options.seed if options.seed is not None else int(known.get("seed", 1))
        self.samples = options.samples or int(known.get("samples", 100))
        self.replicates, self.confidence = int(known.get("replicates", 10)), float(known.get("confidence", 0.95))
        names = [one.name for one in scene.failures]
        if options.failure is not None and options.failure not in names:
            raise Usage(f"--failure {options.failure}: is none of the scene's: {', '.join(names)}")
        self.of = options.failure or ANY
        self.rule: Rule | None = rule(options.until) if options.until is not None else None
        if self.rule is not None and (self.sampling != "monte-carlo" or options.surrogate):
            raise Usage("--until adds samples to a Monte Carlo study: leave --indices, --surrogate and other methods "
                        "out")
        if self.rule is not None:
            self.samples = options.samples or MOST
        if not self.samples <= MOST_SAMPLES:
            raise Usage(f"{self.samples} samples, must be <= {MOST_SAMPLES}: each is kept in memory; for rare failures "
                        "use --method subset")
        if options.surrogate and self.sampling in ("subset", "indices"):
            raise Usage("--surrogate is fitted to plain samples: leave --indices and --method subset out")
        self.assessed = Assessed(sample)
        self.assessed.refuse(self.failures)

    @property
    def each_look(self) -> float:
        """Confidence of the interval of one look."""
        return spent(self.confidence, self.samples) if self.rule is not None else self.confidence

    def counted(self, margins: Any, replicates: int = 1) -> Estimate:
        """The estimate of counted failures, whose interval holds at all looks of --until together."""
        found = counted(margins, self.method, replicates, self.each_look)
        if self.rule is not None:
            found = replace(found, confidence=self.confidence,
                            about=f"{found.about}, for {looks(self.samples)} looks together")
        return found

    @property
    def sampling(self) -> str:
        """The design of the points."""
        return "subset" if self.method == "subset" else "indices" if self.options.indices else self.method

    def identity(self) -> dict[str, Any]:
        """All that the samples of a study depend on beside the scene."""
        found: dict[str, Any] = {"seed": self.seed, "points": self.sampling}
        if self.sampling in ("latin-hypercube", "sobol", "subset"):
            found.update(samples=self.samples, replicates=self.replicates)
        if self.sampling == "subset":
            found.update(failure=self.of)
        if self.sampling == "indices":
            found.update(rows=self.options.indices)
        return found

    def scales(self) -> list[float]:
        """By which margins of different failures are compared."""
        return [abs(one.limit) or 1.0 for one in self.failures]


class StudyResults:
    """The result of one study."""

    def __init__(self, settings: StudySettings, output: CommandOutput) -> None:
        self.settings, self.sample, self.options, self.output = settings, settings.sample, settings.options, output
        if settings.sample.draw.scene.results.get("units"):
            output.note_text("[results] units is ignored: probability writes SI units")
        for one in settings.failures:
            if one.assumed:
                output.note_text(f"{one.name}: limit {amount(one.limit, KINDS[one.kind].unit)} is assumed, because the "
                                 f"scene gives none: {KINDS[one.kind].source}")
        for text in settings.assessed.notes(settings.failures):
            output.note_text(text)
        self.question = self.sample.question
        self.limit = self.sample.names.index(self.options.failure) if self.options.failure else 0
        self.scales = None if self.options.failure else settings.scales()
        self.started = self.shown = clock.monotonic()
        self.estimates: dict[str, Estimate] = {}
        self.demands: dict[str, Demand] = {}
        # whether any failure occurs, or that of --failure, by the number of a sample with all of its margins
        self.failing: dict[int, bool] = {}

    def compute(self) -> int:
        """Computes it; returns the exit status."""
        settings = self.settings
        for text in self.sample.soft.notes() if self.sample.quick else ():
            self.output.note_text(text)
        self.output.say(f"question {self.sample.question}: {LEFT_OUT[self.sample.question]}")
        study = self.study(self.sample, "study.h5")
        if study.results:
            self.output.say(f"{len(study.results)} samples are in {self.output.folder}/study.h5 already")
        try:
            {"indices": self._indices, "subset": self._subset}.get(settings.sampling, self._counted)(study)
        except KeyboardInterrupt:
            self.stopped(study)
        finally:
            self.close(study)
        return self.finish(study)

    def study(self, sample: SceneSample, name: str) -> Study:
        """A study and its file."""
        engine = engines.engine(self.options.engine, self.options.workers, self.options.address)
        file = None
        if self.output.folder is not None:
            file = StudyFile(self.output.path(name), sample, self.settings.identity(), self.options.salvage)
        return Study(sample, engine, file, None if self.options.quiet else self._progress)

    @staticmethod
    def close(study: Study) -> None:
        if study.file is not None:
            study.file.close()

    def stopped(self, study: Study) -> None:
        """A note that Ctrl-C ended it."""
        more = "; the same command continues from there" if study.file is not None else ""
        self.output.stopped(f"stopped by Ctrl-C after {len(study.results)} samples, before there were estimates{more}")

    def _progress(self, at: Progress) -> None:
        now = clock.monotonic()
        if now - self.shown < 1.0 and at.done < at.total:
            return
        self.shown = now
        if sys.stderr.isatty():
            print(f"\r{at.done}/{at.total} samples, {at.lost} without a margin, {now - self.started:.0f} s", end="",
                  file=sys.stderr)

    def report(self, name: str, one: Estimate) -> None:
        """An estimate."""
        lost = f", {one.lost} samples without a margin" if one.lost else ""
        tried = f"{one.lost} runs" if one.method == "auto" else f"{one.samples} samples"
        self.output.say(f"{name}: not assessed, because none of {tried} has a margin" if math.isnan(one.probability)
                        or one.lost == one.samples else
                        f"{name}: {one.probability:.4g}, {100 * one.confidence:g} % interval {one.low:.4g} .. "
                        f"{one.high:.4g} "
                        f"({one.failures} of {one.samples}{lost}; {one.about})")
        one.more.setdefault("effective_samples", float(one.samples - one.lost) if one.method == "monte-carlo" else
                            effective(one.probability, one.low, one.high, one.confidence))
        if one.method != "monte-carlo" and one.more["effective_samples"] is not None:
            self.output.say(f"{name}: as narrow as of {one.more['effective_samples']:.3g} samples of plain Monte Carlo")
        self.estimates[name] = one
        self.output.summary.setdefault("estimates", {})[name] = {**vars(one)}

    # ---- The three ways ----------------------------------------------------------------------------------------------
    def _counted(self, study: Study) -> None:
        numpy, settings = need("numpy"), self.settings
        points = Points(settings.method, settings.seed, self.sample.dimension, settings.samples, settings.replicates)
        results = (self._until(study, points) if settings.rule is not None
                   else study.run(range(points.samples), points.z))
        margins = numpy.array([one.margins for one in results])
        for i, name in enumerate(self.sample.names):
            self.report(name, settings.counted(margins[:, i], points.replicates))
        least = (margins / numpy.array(settings.scales())).min(axis=1)
        self.report(ANY, settings.counted(least, points.replicates))
        if settings.rule is not None:
            self.output.say(f"--until {self.options.until}: {self.settings.of}: "
                            f"{settings.rule.verdict(self.estimates[settings.of])}, after {len(results)} samples")
        self.say_demands(results)
        if self.options.surrogate:
            z = numpy.array([points.z(number) for number in range(points.samples)])
            self._surrogate(z, least if self.scales else margins[:, self.limit])
        self.table(results)

    def _until(self, study: Study, points: Points) -> list[Result]:
        """Results in growing number, until the estimate meets the rule."""
        numpy, settings, count = need("numpy"), self.settings, 0
        assert settings.rule is not None
        while True:
            count = following(count, settings.samples)
            results = study.run(range(count), points.z)
            margins = numpy.array([one.margins for one in results])
            column = (margins / numpy.array(settings.scales())).min(axis=1) if self.scales else margins[:, self.limit]
            if count >= settings.samples or settings.rule.met(settings.counted(column)):
                return results

    def say_demands(self, results: list[Result], weights: Any = None) -> None:
        """Percentiles and rank correlations of the demands. weights: of the results, where they represent different
        numbers of samples."""
        numpy = need("numpy")
        demands, inputs, margins = (numpy.array([getattr(one, key) for one in results], dtype=float)
                                    for key in ("demands", "inputs", "margins"))
        for i, one in enumerate(self.settings.failures):
            found = demand_of(one, demands[:, i], inputs, self.sample.inputs, self.settings.confidence,
                              margins[:, i] if one.name in self.sample.limits.names else None, weights)
            if found is None:
                continue
            self.demands[one.name] = found
            self.output.summary.setdefault("demands", {})[one.name] = found.record()
            self.output.say(found.sentence(self.settings.confidence))
            for text in found.doubts(self.question):
                self.output.note_text(text)
            self._say_matters(found)
        if self.demands:
            self.output.picture("demands.png", lambda plots: plots.demands(list(self.demands.values())))

    def _say_matters(self, found: Demand) -> None:
        counting = [one for one in found.matters if abs(one.rank) > one.least]
        if not found.matters:
            self.output.say(f"{found.failure.name}: rank correlations are not assessed, because the demand is the same "
                            "in all samples or there are "
                            "fewer than 10")
            return
        names = ", ".join(f"{one.name} {one.rank:+.2f}" for one in counting[:4]) or "none of the uncertain parameters"
        self.output.say(f"{found.failure.name}: goes with {names} (rank correlation; chance alone makes "
                        f"{found.matters[0].least:.2f})")

    def _surrogate(self, z: Any, margins: Any) -> None:
        """The estimate by a polynomial; a reason where the samples allow none."""
        known = plan(z.shape[1], len(z))
        self.output.say(f"surrogate: polynomials up to degree {known.degree} of {z.shape[1]} numbers, chosen of "
                        f"{known.terms}, fitted to {len(z)} margins: "
                        f"about {known.seconds:.1g} s of a processor")
        try:
            with ticking("surrogate", known.seconds, not self.options.quiet and sys.stderr.isatty()):
                found = Surrogate(z, margins)
        except ValueError as error:
            self.output.note_text(f"surrogate: not assessed, because of {error}"
                                  + ("; compute more samples" if "must be" in str(error) else ""))
            return
        self.report(f"{self.settings.of}, by a surrogate",
                    found.estimate(self.settings.seed, confidence=self.settings.confidence))
        self.output.say(f"the surrogate: q2 = {found.q2:.4g}, root mean square error {found.error:.4g}, {found.wrong} "
                        "of "
                        f"{found.tested} margins with the wrong sign")

    def _subset(self, study: Study) -> None:
        settings = self.settings
        made = Subset(settings.seed, self.sample.dimension, max(20, settings.samples // settings.replicates),
                      settings.replicates)
        self.report(settings.of, made.run(study.evaluate(self.limit, self.scales), settings.confidence))

    def _indices(self, study: Study) -> None:
        draw = self.sample.draw
        groups = dict(zip(self.sample.inputs, [1] * len(draw.varies.scatters) + draw.sizes[1:]))
        found: Indices = sobol_indices(study.evaluate(self.limit, self.scales), groups, self.options.indices,
                                       self.settings.seed, self.settings.confidence)
        rows = []
        for i in sorted(range(len(found.names)), key=lambda i: -float(found.total[i])):
            self.output.say(f"{found.names[i]}: first order {found.first[i]:.3f} ({found.first_interval[i, 0]:.3f} .. "
                            f"{found.first_interval[i, 1]:.3f}), total {found.total[i]:.3f} "
                            f"({found.total_interval[i, 0]:.3f} .. "
                            f"{found.total_interval[i, 1]:.3f})")
            rows.append([found.names[i],
                         *(float(one) for one in (found.first[i], *found.first_interval[i], found.total[i],
                                                  *found.total_interval[i]))])
        self.output.summary["indices"] = {row[0]: {"first": row[1:4], "total": row[4:7]} for row in rows}
        self.output.summary["indices_lost_rows"] = found.lost
        above = [found.names[i] for i in range(len(found.names)) if found.first[i] > found.total[i]]
        if above:
            self.output.note_text(f"{self.options.indices} rows are too few for these indices: the first-order index "
                                  f"of {', '.join(above)} is above the total one, "
                                  f"which contains it; ask --indices {4 * self.options.indices} or more")
        self.output.table("indices.csv", ["parameter", "first order", "low", "high", "total", "low", "high"], rows)

    # ---- The end -----------------------------------------------------------------------------------------------------
    def table(self, results: list[Result]) -> None:
        """All samples."""
        sample = self.sample
        self.failing = {one.number: (min(one.margins) if self.scales else one.margins[self.limit]) <= 0.0
                        for one in results if usable(one.margins)}
        heads = ["number", "status", "seconds", *sample.inputs, *(f"margin of {name}" for name in sample.names),
                 *(f"demand of {name}" for name in sample.names), "message"]
        rows = ([one.number, "failed" if one.status == FAILED else "done", one.seconds, *one.inputs, *one.margins,
                 *one.demands,
                 one.message] for one in results)
        self.output.table("samples.csv", heads, rows)

    def finish(self, study: Study) -> int:
        """Cost, samples without a margin, summary; returns the exit status: 1 where no sample has margins."""
        if not self.options.quiet and sys.stderr.isatty():
            print(file=sys.stderr)
        lost = sorted(number for number, one in study.results.items() if one.status == FAILED)
        seconds = math.fsum(one.seconds for one in study.results.values())
        elapsed = clock.monotonic() - self.started
        self.output.summary.update(
            seed=self.settings.seed, method=self.settings.method, engine=self.options.engine,
            dimension=self.sample.dimension,
            question=self.question,
            samples=len(study.results), evaluated=study.evaluated, seconds_of_samples=seconds, elapsed=elapsed,
            lost=[{"number": n, "message": study.results[n].message} for n in lost[:1000]])
        for number in lost[:3]:
            self.output.note_text(f"sample {number} (seed {self.settings.seed}) has no margin: "
                                  f"{study.results[number].message}")
        if len(lost) > 3:
            self.output.note_text(f"{len(lost)} samples have no margin; summary.json has the first 1000 of them")
        rate = study.evaluated / elapsed if elapsed > 0.0 else 0.0
        self.output.say(f"{study.evaluated} samples computed in {elapsed:.1f} s, {rate:.3g} a second, "
                        f"{seconds / max(1, len(study.results)):.3g} "
                        f"s of a processor each; {os.path.basename(self.options.scene)}, seed {self.settings.seed}")
        return self.output.finish(1 if study.results and len(lost) == len(study.results) else 0)
