#!/usr/bin/env python3
"""Real-time factor of scenes by the native library: of the part of the run that speed.mjs measures. usage: speed.py
SCENE.toml..."""
import sys
import time

from drillmbd import live_scene, scene

BEGIN, LENGTH, REPEATS = 1.0, 0.1, 40  # as in speed.mjs


def factor(loaded):
    """Simulated over clock time of the fastest repetition, and the hash of the state at its end."""
    with live_scene.model_of(loaded).sim(**loaded.sim) as sim:
        if loaded.run.get("static", 0):
            sim.static(**loaded.fields_of("static"))
        advance(sim, loaded, BEGIN)
        kept, least = sim.snapshot(), float("inf")
        for _ in range(REPEATS):
            sim.restore(kept)
            began = time.perf_counter()
            advance(sim, loaded, BEGIN + LENGTH)
            least = min(least, time.perf_counter() - began)
        return LENGTH / least, f"{sim.hash():016x}"


def advance(sim, loaded, until):
    """The steps of the run up to a time [s]."""
    while sim.time < until - 1e-9:
        sim.step(loaded.run["step"])


def main():
    for file in sys.argv[1:]:
        print("{}: native: {:.2f} times real time, hash {}".format(file, *factor(scene.load(file))))


main()
