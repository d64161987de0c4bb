#!/usr/bin/env python3
"""How many samples of rig.toml does this machine compute in a second, by engine and number of workers? The engines in
turn, the median of some rounds; for a machine with nothing else to do.

    python3 examples/failure_probability/scaling.py [--samples 24] [--rounds 3] [--workers 2]
    python3 examples/failure_probability/scaling.py --cycle 200 --samples 3    # a sample of the whole cycle of 100
    pipes at 200 rpm"""
import argparse
import os
import pathlib
import resource
import statistics
import sys
import tempfile
import time

HERE = pathlib.Path(__file__).resolve().parent
sys.path[:0] = [str(HERE.parents[1] / "bindings" / "python")] if not os.environ.get("PYTHONPATH") else []
if "DRILLMBD_LIBRARY" not in os.environ and (HERE.parents[1] / "build/release/libdrillmbd.so").exists():
    os.environ["DRILLMBD_LIBRARY"] = str(HERE.parents[1] / "build/release/libdrillmbd.so")

from drillmbd.probability import engines  # noqa: E402
from drillmbd.probability.sample import SceneSample  # noqa: E402
from drillmbd.probability.sampling import Points  # noqa: E402
from drillmbd.probability.study import Study, StudyFile  # noqa: E402


def rig(changes):
    """Samples of rig.toml with changes."""
    return SceneSample((HERE / "rig.toml").read_text(encoding="utf-8"), "rig.toml", str(HERE), changes=changes)


def results_of(sample, engine, samples):
    """Computed by this engine, written to a file as a study does."""
    with tempfile.TemporaryDirectory() as folder, StudyFile(pathlib.Path(folder, "study.h5"), sample,
                                                            {"seed": 1}) as file:
        return Study(sample, engine, file).run(range(samples), Points("monte-carlo", 1, sample.dimension, samples).z)


def seconds(engine, workers, samples):
    """That the samples take by this engine, with the start of its workers."""
    sample, started = rig({}), time.monotonic()
    results_of(sample, engines.engine(engine, workers), samples)
    return time.monotonic() - started


def cycle(speed, samples):
    """Prints seconds and memory of samples of the whole cycle, one after the other."""
    turns = {f"time_function[1].segment[{i}].h1": f"{sign * speed} rpm" for i, sign in enumerate((1, -1, -1))}
    results = results_of(rig({"run.end": "40 s", "string[0].pipes[0].count": 100, **turns}), engines.engine("serial"),
                         samples)
    took = [one.seconds for one in results]
    memory = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024.0
    print(f"{speed} rpm: {statistics.mean(took):.1f} s a sample ({min(took):.1f} .. {max(took):.1f}), {memory:.0f} MB")


def main():
    words = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    words.add_argument("--samples", type=int, default=24, help="of each engine in each round")
    words.add_argument("--rounds", type=int, default=3)
    words.add_argument("--workers", type=int, default=2)
    words.add_argument("--cycle", type=int, metavar="RPM",
                       help="instead: cost of a sample of the whole cycle, from 1 to 1000 rpm")
    options = words.parse_args()
    if min(options.samples, options.rounds, options.workers) < 1:
        words.error("--samples, --rounds and --workers must be >= 1")
    if options.cycle is not None:
        if not 1 <= options.cycle <= 1000:
            words.error("--cycle: must be a speed from 1 to 1000 rpm")
        return cycle(options.cycle, options.samples)
    ways = [("serial", 1), ("processes", options.workers), ("threads", options.workers)]
    found = {way: [] for way in ways}
    for _ in range(options.rounds):
        for way in ways:
            found[way].append(seconds(*way, options.samples))
    ratios = {way: statistics.median(one / other for one, other in zip(found[ways[0]], found[way])) for way in ways}
    for way in ways:
        print(f"{way[0]:>10} {way[1]:3d} {options.samples / statistics.median(found[way]):8.3f} samples/s, "
              f"{ratios[way]:.2f} times serial")


if __name__ == "__main__":
    main()
