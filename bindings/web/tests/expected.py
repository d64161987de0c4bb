#!/usr/bin/env python3
"""Prints the figures that the live page must reach: torque and thrust at the rig by `drillmbd run`, and the hash of the page's model by the native library.

usage: expected.py SCENE.toml TIME [--hash] > expected.json; --hash: the hash alone, without a run of the command"""
import csv
import json
import pathlib
import sys
import tempfile

from drillmbd import command, live_scene, scene


def last_row(file, time):
    """Time, torque and thrust of the last row that `drillmbd run` writes: outputs named so."""
    with tempfile.TemporaryDirectory() as folder:
        if command.main(["run", file, "--until", f"{time} s", "--output", folder, "--quiet"]) != 0:
            sys.exit("expected.py: the run failed")
        with open(pathlib.Path(folder) / "run.csv", encoding="utf-8", newline="") as table:
            rows = list(csv.reader(table))
    column = {name.split(" [")[0]: number for number, name in enumerate(rows[0])}
    return [float(rows[-1][column[name]]) for name in ("time", "torque at the rig", "push at the rig")]


def native_hash(loaded, time):
    """Of the model with the page's inputs, after the same steps."""
    with live_scene.model_of(loaded).sim(**loaded.sim) as sim:
        if loaded.run.get("static", 0):
            sim.static(**loaded.fields_of("static"))
        while sim.time < time - 1e-9:
            sim.step(loaded.run["step"])
        return f"{sim.hash():016x}"


def main():
    file, time = sys.argv[1], float(sys.argv[2])
    if "--hash" in sys.argv:
        print(json.dumps({"time": time, "hash": native_hash(scene.load(file), time)}))
        return
    reached, torque, thrust = last_row(file, time)
    print(json.dumps({"time": reached, "torque": torque, "thrust": thrust, "hash": native_hash(scene.load(file), time)}))


main()
