"""The question `drillmbd probability`: a study of a scene file by an engine, its estimates told and written."""
from __future__ import annotations

import argparse
import os
import pathlib
import sys
import time as clock
from typing import Any

from .._optional import need
from ..answers import Output
from ..errors import Usage
from ..runner import carry_out
from ..scene import load
from . import engines
from .draw import CannotDraw
from .estimates import Estimate, Indices, Subset, Surrogate, counted, sobol_indices
from .points import Points
from .sample import FAILED, Own, Result, SceneSample
from .study import Progress, Study, StudyError, StudyFile


LEAST = """[variability]
samples = 100
[[variability.scatter]]        # what is uncertain
key = "hole.mu_dynamic"
distribution = "uniform"
low = 0.2
high = 0.4
[[failure]]                    # what must not happen
kind = "stress"
strength = "500 MPa"
"""


def _own(texts: list[str]) -> dict[str, Own]:
    """NAME=FILE.py:FUNCTION"""
    found = {}
    for text in texts:
        name, _, place = text.partition("=")
        file, _, function = place.rpartition(":")
        if not name or not file or not function:
            raise Usage(f"--own {text}: write NAME=FILE.py:FUNCTION")
        found[name] = Own(str(pathlib.Path(file).resolve()), function)
        try:
            found[name].load()
        except OSError:
            raise
        except Exception as error:  # a file of Python may raise anything
            raise Usage(f"--own {text}: {error}") from error
    return found


def probability(options: argparse.Namespace) -> int:
    """Answers it; returns the exit status: 1 where no sample has margins."""
    for name in ("samples", "workers", "indices"):
        if getattr(options, name) is not None and getattr(options, name) < 1:
            raise Usage(f"--{name} {getattr(options, name)}: must be >= 1")
    if options.seed is not None and not 0 <= options.seed < 2 ** 63:
        raise Usage(f"--seed {options.seed}: must be 0 .. 2^63 - 1")
    path = pathlib.Path(options.scene)
    known = load(path)  # SceneError tells what is wrong
    if known.variability is None or not known.failures:
        missing = " and ".join(name for name, there in (("[variability]", known.variability), ("[[failure]]", known.failures)) if not there)
        raise Usage(f"{path} has no {missing}; the least is\n\n" + LEAST)
    text = path.read_text(encoding="utf-8-sig")
    sample = SceneSample(text, str(path), str(path.parent.resolve()), _own(options.own))
    try:
        sample.names
        if options.engine == "mpi":
            rank, size = engines.mpi_rank()
            if size < 2:
                raise Usage("--engine mpi needs two ranks or more: mpirun -n 3 drillmbd probability ... --engine mpi")
            if rank > 0:
                with engines.mpi_together():
                    engines.mpi_work(sample)
                return 0
        asked = _Asked(sample, options)
        return carry_out(sample.draw.scene, asked.output, options, lambda *_: _answer(asked))
    except (CannotDraw, StudyError) as error:
        raise Usage(str(error)) from error
    finally:
        if options.engine == "mpi" and "size" in locals() and size > 1 and rank == 0:
            engines.mpi_end()


def _answer(asked: _Asked) -> int:
    try:
        return asked.answer()
    except (CannotDraw, StudyError) as error:
        raise Usage(str(error)) from error


class _Asked:
    """One answer."""

    def __init__(self, sample: SceneSample, options: argparse.Namespace) -> None:
        self.sample, self.options = sample, options
        scene = sample.draw.scene
        varies = sample.draw.varies
        known = varies.settings
        self.method = options.method or varies.method
        self.seed = options.seed if options.seed is not None else int(known.get("seed", 1))
        self.samples = options.samples or int(known.get("samples", 100))
        self.replicates, self.confidence = int(known.get("replicates", 10)), float(known.get("confidence", 0.95))
        if options.failure is not None and options.failure not in sample.names:
            raise Usage(f"--failure {options.failure}: is none of the scene's: {', '.join(sample.names)}")
        self.output = Output(options.output, options.scene, scene, "probability", options.quiet)
        self.output.started = options.started
        if scene.output.get("units"):
            self.output.note_text("[output] units is ignored: probability writes SI units")
        self.limit = sample.names.index(options.failure) if options.failure else 0
        self.scales = None if options.failure else [abs(one.limit) or 1.0 for one in scene.failures]
        self.of = options.failure or "any failure"
        self.started = self.told = clock.monotonic()

    def answer(self) -> int:
        engine = engines.engine(self.options.engine, self.options.workers, self.options.address)
        sampling = "subset" if self.method == "subset" else "indices" if self.options.indices else self.method
        settings: dict[str, Any] = {"seed": self.seed, "points": sampling}
        if sampling in ("latin-hypercube", "sobol", "subset"):
            settings.update(samples=self.samples, replicates=self.replicates)
        if sampling == "subset":
            settings.update(failure=self.of)
        if sampling == "indices":
            settings.update(rows=self.options.indices)
        file = None
        if self.output.folder is not None:
            file = StudyFile(self.output.path("study.h5"), self.sample, settings, self.options.salvage)
        study = Study(self.sample, engine, file, None if self.options.quiet else self._progress)
        if study.results:
            self.output.say(f"{len(study.results)} samples are in {self.output.folder}/study.h5 already")
        try:
            if sampling == "indices":
                self._indices(study)
            elif sampling == "subset":
                self._subset(study)
            else:
                self._counted(study)
        except KeyboardInterrupt:
            more = "; the same command goes on from there" if file is not None else ""
            self.output.stopped(f"stopped by Ctrl-C after {len(study.results)} samples, before there were estimates{more}")
        finally:
            if file is not None:
                file.close()
        return self._finish(study)

    def _progress(self, at: Progress) -> None:
        now = clock.monotonic()
        if now - self.told < 1.0 and at.done < at.asked:
            return
        self.told = now
        if sys.stderr.isatty():
            print(f"\r{at.done}/{at.asked} samples, {at.lost} without a margin, {now - self.started:.0f} s", end="", file=sys.stderr)

    def _told(self, name: str, one: Estimate) -> None:
        lost = f", {one.lost} samples without a margin" if one.lost else ""
        self.output.say(f"{name}: {one.probability:.4g}, {100 * one.confidence:g} % interval {one.low:.4g} .. {one.high:.4g} "
                        f"({one.failures} of {one.samples}{lost}; {one.about})")
        self.output.summary.setdefault("estimates", {})[name] = {**vars(one)}

    # ---- The three ways ----------------------------------------------------------------------------------------------
    def _counted(self, study: Study) -> None:
        numpy = need("numpy")
        points = Points(self.method, self.seed, self.sample.dimension, self.samples, self.replicates)
        results = study.run(range(points.samples), points.z)
        margins = numpy.array([one.margins for one in results])
        for i, name in enumerate(self.sample.names):
            self._told(name, counted(margins[:, i], self.method, points.replicates, self.confidence))
        scales = numpy.array([abs(one.limit) or 1.0 for one in self.sample.draw.scene.failures])
        self._told("any failure", counted((margins / scales).min(axis=1), self.method, points.replicates, self.confidence))
        if self.options.surrogate:
            z = numpy.array([points.z(number) for number in range(points.samples)])
            self._surrogate(z, (margins / scales).min(axis=1) if self.scales else margins[:, self.limit])
        self._table(results)

    def _surrogate(self, z: Any, margins: Any) -> None:
        """The estimate by a polynomial; a reason where the samples allow none."""
        try:
            found = Surrogate(z, margins)
        except ValueError as error:
            self.output.note_text(f"surrogate: not assessed, because of {error}; compute more samples")
            return
        self._told(f"{self.of}, by a surrogate", found.estimate(self.seed, confidence=self.confidence))
        self.output.say(f"the surrogate: q2 = {found.q2:.4g}, root mean square error {found.error:.4g}, {found.wrong} of "
                        f"{found.tested} margins with the wrong sign")

    def _subset(self, study: Study) -> None:
        made = Subset(self.seed, self.sample.dimension, max(20, self.samples // self.replicates), self.replicates)
        self._told(self.of, made.run(study.evaluate(self.limit, self.scales), self.confidence))

    def _indices(self, study: Study) -> None:
        groups = dict(zip(self.sample.inputs, self._sizes()))
        found: Indices = sobol_indices(study.evaluate(self.limit, self.scales), groups, self.options.indices, self.seed, self.confidence)
        rows = []
        for i in sorted(range(len(found.names)), key=lambda i: -float(found.total[i])):
            self.output.say(f"{found.names[i]}: first order {found.first[i]:.3f} ({found.first_interval[i, 0]:.3f} .. "
                            f"{found.first_interval[i, 1]:.3f}), total {found.total[i]:.3f} ({found.total_interval[i, 0]:.3f} .. "
                            f"{found.total_interval[i, 1]:.3f})")
            rows.append([found.names[i], *(float(one) for one in (found.first[i], *found.first_interval[i], found.total[i],
                                                                  *found.total_interval[i]))])
        self.output.summary["indices"] = {row[0]: {"first": row[1:4], "total": row[4:7]} for row in rows}
        self.output.summary["indices_lost_rows"] = found.lost
        self.output.table("indices.csv", ["what varies", "first order", "low", "high", "total", "low", "high"], rows)

    def _sizes(self) -> list[int]:
        draw = self.sample.draw
        return [1] * len(draw.varies.scatters) + draw.sizes[1:]

    # ---- The end -----------------------------------------------------------------------------------------------------
    def _table(self, results: list[Result]) -> None:
        sample = self.sample
        heads = ["number", "status", "seconds", *sample.inputs, *(f"margin of {name}" for name in sample.names),
                 *(f"demand of {name}" for name in sample.names), "message"]
        rows = ([one.number, "failed" if one.status == FAILED else "done", one.seconds, *one.inputs, *one.margins, *one.demands,
                 one.message] for one in results)
        self.output.table("samples.csv", heads, rows)

    def _finish(self, study: Study) -> int:
        if not self.options.quiet and sys.stderr.isatty():
            print(file=sys.stderr)
        lost = sorted(number for number, one in study.results.items() if one.status == FAILED)
        seconds = sum(one.seconds for one in study.results.values())
        elapsed = clock.monotonic() - self.started
        self.output.summary.update(
            seed=self.seed, method=self.method, engine=self.options.engine, dimension=self.sample.dimension,
            samples=len(study.results), evaluated=study.evaluated, seconds_of_samples=seconds, elapsed=elapsed,
            lost=[{"number": n, "message": study.results[n].message} for n in lost[:1000]])
        for number in lost[:3]:
            self.output.note_text(f"sample {number} (seed {self.seed}) has no margin: {study.results[number].message}")
        if len(lost) > 3:
            self.output.note_text(f"{len(lost)} samples have no margin; summary.json has the first 1000 of them")
        rate = study.evaluated / elapsed if elapsed > 0.0 else 0.0
        self.output.say(f"{study.evaluated} samples computed in {elapsed:.1f} s, {rate:.3g} a second, {seconds / max(1, len(study.results)):.3g} "
                        f"s of a processor each; {os.path.basename(self.options.scene)}, seed {self.seed}")
        return self.output.finish(1 if len(lost) == len(study.results) else 0)
