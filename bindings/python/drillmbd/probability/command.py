"""The command `drillmbd probability`: a study of a scene file by an engine, its estimates printed and written."""
from __future__ import annotations

import argparse
import pathlib

from ..results import CommandOutput
from ..errors import Usage
from ..runner import carry_out
from ..scene import load
from . import cells, engines
from .results import StudyResults, StudySettings
from .auto import Auto
from .draw import CannotDraw
from .sample import Own, SceneSample
from .study import StudyError


LEAST = """[variability]
samples = 100
[[variability.scatter]]        # an uncertain parameter
keys = ["hole.mu_static", "hole.mu_dynamic"]
relative = true                # factors of the values in the scene
distribution = "uniform"
low = 0.7
high = 1.3
[[failure]]                    # a failure
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
    """Computes it; returns the exit status: 1 where no sample has margins."""
    for name in ("samples", "workers", "indices"):
        if getattr(options, name) is not None and getattr(options, name) < 1:
            raise Usage(f"--{name} {getattr(options, name)}: must be >= 1")
    if options.seed is not None and not 0 <= options.seed < 2 ** 63:
        raise Usage(f"--seed {options.seed}: must be 0 .. 2^63 - 1")
    path = pathlib.Path(options.scene)
    known = load(path)  # SceneError names each fault
    if known.variability is None or not known.failures:
        missing = " and ".join(name for name, there in (("[variability]", known.variability),
                                                        ("[[failure]]", known.failures)) if not there)
        raise Usage(f"{path} has no {missing}. A scene of `drillmbd new` has them as commented lines at its end: take "
                    "the # away there, or add lines, for example:\n\n" + LEAST)
    question = options.question or known.variability.question
    sample = SceneSample(path.read_text(encoding="utf-8-sig"), str(path), str(path.parent.resolve()), _own(options.own),
                         given_question="run" if question == "auto" else question)
    try:
        if options.vary:
            return cells.probability_map(sample, options)
        sample.names
        if options.engine == "mpi":
            return _with_mpi(sample, options, question)
        return _alone(sample, options, question)
    except (CannotDraw, StudyError) as error:
        raise Usage(str(error)) from error


def _alone(sample: SceneSample, options: argparse.Namespace, question: str) -> int:
    """The result of one scene by this process, which has the workers."""
    settings = StudySettings(sample, options)
    output = CommandOutput(options.output, options.scene, sample.draw.scene, "probability", options.quiet)
    output.started = options.started
    made = Auto(settings, output) if question == "auto" else StudyResults(settings, output)
    return carry_out(sample.draw.scene, output, options, lambda *_: _computed(made))


def _with_mpi(sample: SceneSample, options: argparse.Namespace, question: str) -> int:
    rank, size = engines.mpi_rank()
    if size < 2:
        raise Usage("--engine mpi needs two ranks or more: mpirun -n 3 drillmbd probability ... --engine mpi")
    if question == "auto":
        raise Usage("--engine mpi has one question at a time, and auto two: choose --question torque-drag, static or "
                    "run, or another --engine")
    if rank > 0:
        with engines.mpi_together():
            engines.mpi_work(sample)
        return 0
    try:
        return _alone(sample, options, question)
    finally:
        engines.mpi_end()


def _computed(made: StudyResults) -> int:
    try:
        return made.compute()
    except (CannotDraw, StudyError) as error:
        raise Usage(str(error)) from error
