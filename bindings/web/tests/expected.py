#!/usr/bin/env python3
"""Prints the figures that the live page must reach: torque and thrust at the rig by `drillmbd run`, and the hash of the
page's model by the native library.

usage: expected.py SCENE.toml TIME [--hash] > expected.json; --hash: the hash and the outputs of the page's traces
alone, without a run of the command"""
import csv
import json
import pathlib
import sys
import tempfile

from drillmbd import command, live_scene, scene
from drillmbd._structs import Id, Place


def last_row(file, time):
    """Time, torque and thrust of the last row that `drillmbd run` writes: outputs named so."""
    with tempfile.TemporaryDirectory() as folder:
        if command.main(["run", file, "--until", f"{time} s", "--output", folder, "--quiet"]) != 0:
            sys.exit("expected.py: the run failed")
        with open(pathlib.Path(folder) / "run.csv", encoding="utf-8", newline="") as table:
            rows = list(csv.reader(table))
    column = {name.split(" [")[0]: number for number, name in enumerate(rows[0])}
    return [float(rows[-1][column[name]]) for name in ("time", "torque at the rig", "push at the rig")]


def native(loaded, time):
    """Hash and outputs of the traces, of the model with the page's inputs, after the same steps."""
    model, record = live_scene.model_of(loaded), live_scene.record_of(loaded, "")
    places = [line for trace in record["traces"] for line in trace["lines"]]
    with model.sim(**loaded.sim) as sim:
        if loaded.run.get("static", 0):
            sim.static(**loaded.fields_of("static"))
        while sim.time < time - 1e-9:
            sim.step(loaded.run["step"])
        return {"hash": f"{sim.hash():016x}", "values": [sim.output(one["quantity"], place_of(model, one["place"]))
                                                         for one in places]}


def place_of(model, given):
    """A place of a record in this model."""
    part = given["part"]
    return Place(model.own(Id(part["index"], 1)), pipe=given["pipe"],
                 fraction=given["fraction"]) if part["generation"] else Place()


def main():
    file, time = sys.argv[1], float(sys.argv[2])
    if "--hash" in sys.argv:
        print(json.dumps({"time": time, **native(scene.load(file), time)}))
        return
    reached, torque, thrust = last_row(file, time)
    print(json.dumps({"time": reached, "torque": torque, "thrust": thrust, **native(scene.load(file), time)}))


main()
