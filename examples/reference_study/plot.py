#!/usr/bin/python3
"""Pictures of reference_study.

usage: plot.py FOLDER

Reads the tables that reference_study has written into the folder, and writes four pictures beside them: the response of
pipe 100, the modes, frequencies against lengths, and what depends on which parameter.
"""
import csv
import pathlib
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np
from matplotlib.ticker import NullLocator

BLUE, ORANGE, GREEN, RED, GREY = "#1f5fa8", "#d9730d", "#2e7d4f", "#b3261e", "#6b7280"
ORDERS = ("#1f5fa8", "#4f83bd", "#7fa6d0", "#a9c3e0", "#cfdcee")
REFERENCE_RANGE, REFERENCE_CROSSOVER = (6.9e-3, 2.1e4), 1.58  # [Hz]
CLEARANCE = 10.5  # [mm] of the base string

plt.rcParams.update({
    "figure.dpi": 110, "font.size": 11, "font.family": "DejaVu Sans", "axes.titlesize": 11, "axes.labelsize": 11,
    "axes.spines.top": False, "axes.spines.right": False, "axes.grid": True, "grid.color": "#dddddd",
    "grid.linewidth": 0.6, "axes.axisbelow": True, "legend.frameon": False, "legend.fontsize": 10.5,
    "figure.constrained_layout.use": True, "axes.formatter.useoffset": False})


def columns(folder, name):
    with open(folder / name, encoding="utf-8", newline="") as text:
        names = next(csv.reader(text))
    return dict(zip(names, np.loadtxt(folder / name, delimiter=",", skiprows=1, ndmin=2).T))


def parameter_sets(folder):
    """Name of each parameter: columns of its points."""
    sets = {}
    with open(folder / "parameters.csv", encoding="utf-8", newline="") as text:
        for row in csv.DictReader(text):
            points = sets.setdefault(row.pop("parameter"), {name: [] for name in row})
            for name, value in row.items():
                points[name].append(float(value))
    return {name: {key: np.array(values) for key, values in points.items()} for name, points in sets.items()}


def finish(folder, figure, name):
    figure.savefig(folder / name)
    plt.close(figure)
    print(f"  {name}")


def response(folder):
    table = columns(folder, "response.csv")
    frequency = table["frequency [Hz]"]
    friction, eccentricity = 1e3 * table["friction [m]"], 1e3 * table["eccentricity [m]"]
    figure, axes = plt.subplots(figsize=(12, 6.5))
    axes.fill_between(frequency, 1e-7, 1e4, where=eccentricity > friction, color="#fbeede", linewidth=0, zorder=0,
                      label="eccentricity is stronger than friction")
    for name, values, color, width in (
            ("all three", 1e3 * table["all three [m]"], GREY, 2.6), ("drives", 1e3 * table["drives [m]"], GREEN, 1.3),
            ("friction", friction, BLUE, 1.3), ("eccentric masses", eccentricity, ORANGE, 1.3)):
        axes.loglog(frequency, values, color=color, linewidth=width, label=name,
                    alpha=0.55 if name == "all three" else 1.0)
    axes.axvline(REFERENCE_CROSSOVER, color=RED, linewidth=1.2, linestyle="--",
                 label=f"crossover of the reference, {REFERENCE_CROSSOVER} Hz")
    axes.axhline(CLEARANCE, color=GREY, linewidth=1.0, linestyle=":",
                 label="clearance: above it linear amplitudes\nonly compare the causes")
    axes.set(xlabel="frequency [Hz]", ylabel="amplitude of the middle of pipe 100 [mm]",
             xlim=(frequency[0], frequency[-1]), ylim=(1e-4, 3e2),
             title="What shakes pipe 100: the string lies on the wall of its hole")
    axes.legend(loc="upper left", bbox_to_anchor=(1.0, 1.0))
    finish(folder, figure, "response_of_pipe_100.png")


def modes(folder):
    table, shapes, highest = (columns(folder, name) for name in ("modes.csv", "shapes.csv", "highest.csv"))
    figure, (left, middle, right) = plt.subplots(1, 3, figsize=(16, 5.2), width_ratios=(1.5, 1, 1))
    names = [name for name in shapes if name.startswith("mode")]
    for number, (name, color) in enumerate(zip(names, (BLUE, ORANGE, GREEN, RED, GREY))):
        left.plot(shapes["x [m]"], shapes[name] / np.abs(shapes[name]).max() - 2.3 * number, color=color)
        left.axhline(-2.3 * number, color="#999999", linewidth=0.6)
    left.set(yticks=[-2.3 * number for number in range(len(names))], yticklabels=names, xlabel="from the rig [m]",
             title="Shapes of the string held by its drives, without a wall")
    left.grid(axis="y", visible=False)
    swings = table["frequency [Hz]"] > 1e-4
    middle.semilogy(table["mode"][swings], table["frequency [Hz]"][swings], ".", color=BLUE, markersize=3,
                    label="one element a pipe")
    middle.set(xlabel="mode", ylabel="frequency [Hz]", title="All modes")
    right.plot(highest["elements in a pipe"], highest["highest frequency [Hz]"], "o-", color=BLUE)
    right.set(xlabel="elements in a pipe", ylabel="highest frequency [Hz]", title="The highest belongs to the mesh",
              ylim=(0, None))
    for value in REFERENCE_RANGE:
        middle.axhline(value, color=RED, linewidth=1.2, linestyle="--",
                       label="range of the reference" if value == REFERENCE_RANGE[0] else None)
    right.axhline(REFERENCE_RANGE[1], color=RED, linewidth=1.2, linestyle="--", label="highest of the reference")
    middle.legend(loc="lower right", bbox_to_anchor=(1.0, 0.08))
    right.legend(loc="lower right")
    finish(folder, figure, "modes.png")


def lengths(folder):
    sets = parameter_sets(folder)
    figure, places = plt.subplots(1, 2, figsize=(13, 6), sharey=True)
    for axes, name, title in zip(places, ("drilled length [m]", "pipe length [m]"),
                                 ("Drilled length, pipes of 1 m", "Length of each pipe, 100 m drilled")):
        points = sets[name]
        for order, color in zip(range(5, 0, -1), reversed(ORDERS)):
            axes.loglog(points["value"], points[f"bending {order} [Hz]"], "o-", markersize=4, color=color,
                        label=f"bending without a wall, order {order}")
        for key, label, color in (("axial [Hz]", "along", RED), ("torsional [Hz]", "around", ORANGE),
                                  ("on the wall [Hz]", "lowest on the wall", GREEN)):
            axes.loglog(points["value"], points[key], "s-", markersize=4, color=color, label=label)
        axes.set(xlabel=name, title=title)
        ticks = [value for value in points["value"] if value not in (60, 70, 80, 90)]
        axes.set_xticks(ticks, [f"{value:g}" for value in ticks])
        axes.xaxis.set_minor_locator(NullLocator())
    places[0].set_ylabel("natural frequency [Hz]")
    handles, labels = places[0].get_legend_handles_labels()
    order = np.argsort([-handle.get_ydata()[-1] for handle in handles])
    places[1].legend([handles[i] for i in order], [labels[i] for i in order], loc="center left",
                     bbox_to_anchor=(1.0, 0.5))
    finish(folder, figure, "frequencies_against_lengths.png")


def parameters(folder):
    quantities = (("bending 1 [Hz]", "first bending, no wall", BLUE, "o"), ("axial [Hz]", "first along", RED, "s"),
                  ("on the wall [Hz]", "lowest on the wall", GREEN, "^"), ("torque [N m]", "torque of the head", ORANGE, "D"),
                  ("crossover [Hz]", "crossover", GREY, "v"))
    sets = parameter_sets(folder)
    base = {key: values[-1] for key, values in sets["drilled length [m]"].items()}
    figure, places = plt.subplots(2, 4, figsize=(16, 8))
    for axes, (name, points) in zip(places.ravel(), sets.items()):
        for key, label, color, marker in quantities:
            axes.plot(points["value"], points[key] / base[key], marker + "-", color=color, markersize=5, linewidth=1.2,
                      label=label)
        if name == "drilled length [m]":
            axes.set(xlabel=name + ", both scales logarithmic", yscale="log", xscale="log")
            axes.set_xticks((10, 20, 50, 100), ("10", "20", "50", "100"))
            axes.xaxis.set_minor_locator(NullLocator())
        elif name == "wall stiffness [MN/m2]":
            axes.set(xlabel=name, ylim=(0, 2), xscale="log")
        else:
            axes.set(xlabel=name, ylim=(0, 2))
            if name == "elements in a pipe":
                axes.set_xticks(points["value"])
    for row in places:
        row[0].set_ylabel("over that of the base string")
    places[-1][-1].axis("off")
    handles, labels = places[0][0].get_legend_handles_labels()
    places[-1][-1].legend(handles, labels, loc="center", fontsize=12)
    figure.suptitle("What depends on what: one parameter changed at a time, 100 pipes of 1 m in a hole of 94 mm",
                    fontsize=13, x=0.01, ha="left")
    finish(folder, figure, "parameter_studies.png")


def main():
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    for picture in (response, modes, lengths, parameters):
        picture(pathlib.Path(sys.argv[1]))


main()
