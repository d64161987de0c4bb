#!/usr/bin/env python3
"""How many samples of a study does this machine compute in a second, by engine and number of workers? One case of study.py's short
form, the ways in turn, the median of some rounds; for a machine with nothing else to do.

    python3 examples/failure_probability/scaling.py [--samples 24] [--rounds 3] [--workers 2]
    python3 examples/failure_probability/scaling.py --cycle 200 --samples 3    # a sample of the whole cycle at 200 rpm"""
import argparse
import resource
import statistics
import tempfile
import time
from types import SimpleNamespace

import study
from drillmbd.probability.sampling import Points


def seconds(engine, workers, samples):
    """That the samples take by this engine, with the start of its workers."""
    with tempfile.TemporaryDirectory() as folder:
        work = study.Work(SimpleNamespace(form="short", output=folder, engine=engine, workers=workers, address=None))
        sample = work.sample(study.ALL, 250, 5)
        what, file = work.study("scaling", sample, {"seed": 1})
        started = time.monotonic()
        with file:
            what.run(range(samples), Points("monte-carlo", 1, sample.dimension, samples).z)
        return time.monotonic() - started


def cycle(speed, samples):
    """Prints seconds and memory of samples of the long form, one after the other."""
    with tempfile.TemporaryDirectory() as folder:
        work = study.Work(SimpleNamespace(form="long", output=folder, engine="serial", workers=1, address=None))
        sample = work.sample(study.ALL, speed, 10)
        what, file = work.study("cycle", sample, {"seed": 1})
        with file:
            results = what.run(range(samples), Points("monte-carlo", 1, sample.dimension, samples).z)
    took = [one.seconds for one in results]
    memory = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024.0
    print(f"{speed} rpm: {statistics.mean(took):.1f} s a sample ({min(took):.1f} .. {max(took):.1f}), {memory:.0f} MB")


def main():
    words = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    words.add_argument("--samples", type=int, default=24, help="of each way in each round")
    words.add_argument("--rounds", type=int, default=3)
    words.add_argument("--workers", type=int, default=2)
    words.add_argument("--cycle", type=int, metavar="RPM", help="instead: cost of a sample of the whole cycle, from 1 to 1000 rpm")
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
        print(f"{way[0]:>10} {way[1]:3d} {options.samples / statistics.median(found[way]):8.3f} samples/s, {ratios[way]:.2f} times serial")


if __name__ == "__main__":
    main()
