#!/usr/bin/python3
"""Pictures of reference_study.

usage: plot.py FOLDER

Reads the tables that reference_study has written into the folder, and writes pictures beside them: the response of pipe
100, the modes, frequencies against lengths, what depends on which parameter, and the kinetic energy of pipe 100 in time
(not after a run with --short).
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
    """Figure 11 of the study shows X; Y and Z stand beside it."""
    table = columns(folder, "response.csv")
    frequency = table["frequency [Hz]"]
    figure, places = plt.subplots(1, 3, figsize=(16, 5.6), sharex=True)
    for axes, axis, way in zip(places, "XYZ", ("along the hole, as in the study's figure 11", "across it", "up")):
        friction, along, eccentricity = (1e3 * table[f"{cause} {axis} [m]"]
                                         for cause in ("friction", "friction along", "eccentricity"))
        axes.fill_between(frequency, 1e-9, 1e4, where=eccentricity > friction, color="#fbeede", linewidth=0, zorder=0,
                          label="eccentricity is stronger than\nfriction around the string")
        for name, values, color, width, style in (
                ("all three", 1e3 * table[f"all three {axis} [m]"], GREY, 2.6, "-"),
                ("drives", 1e3 * table[f"drives {axis} [m]"], GREEN, 1.3, "-"),
                ("friction around the string", friction, BLUE, 1.3, "-"),
                ("the same coefficient along it", along, BLUE, 1.1, ":"),
                ("eccentric masses", eccentricity, ORANGE, 1.3, "-")):
            axes.loglog(frequency, values, color=color, linewidth=width, label=name, linestyle=style,
                        alpha=0.55 if name == "all three" else 1.0)
        axes.axvline(REFERENCE_CROSSOVER, color=RED, linewidth=1.2, linestyle="--",
                     label=f"crossover of the study, {REFERENCE_CROSSOVER} Hz")
        axes.axhline(CLEARANCE, color=GREY, linewidth=1.0, linestyle=":",
                     label="clearance: above it linear amplitudes\nonly compare the causes")
        least = min(friction.min(), eccentricity.min(), 1e3 * table[f"drives {axis} [m]"].min())
        axes.set(xlabel="frequency [Hz]", xlim=(frequency[0], frequency[-1]), title=f"{axis}: {way}",
                 ylim=(0.5 * least, 3e2))
    places[0].set_ylabel("amplitude of the middle of pipe 100 [mm]")
    places[2].legend(loc="upper left", bbox_to_anchor=(1.0, 1.0))
    figure.suptitle("What shakes pipe 100: the string lies on the wall of its hole", fontsize=13, x=0.01, ha="left")
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
    for key, label, color in (("by elements [Hz]", "elements", BLUE),
                              ("by modes [Hz]", "12 shapes and normal modes", ORANGE)):
        right.plot(highest["coordinates of a pipe"], highest[key], "o-", color=color, label=label)
    right.set(xlabel="independent coordinates of a pipe", ylabel="highest frequency [Hz]",
              title="The highest: how pipes are described", ylim=(0, None))
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
                                  ("first on the wall [Hz]", "lowest on the wall", GREEN)):
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


# Quantities of a string, a row each: column, factor, label, colour, marker.
ROWS = (
    ("frequency [Hz]", True, (("axial [Hz]", 1.0, "first along", RED, "s"),
                              ("torsional [Hz]", 1.0, "first around", ORANGE, "D"),
                              ("first on the wall [Hz]", 1.0, "lowest on the wall", GREEN, "^"),
                              ("bending 1 [Hz]", 1.0, "first bending, no wall", BLUE, "o"))),
    ("thrust of the head [kN]", False, (("push [N]", 1e-3, "sliding only", BLUE, "o"),
                                        ("thrust [N]", 1e-3, "turning too", GREEN, "^"))),
    ("torque [N m]", False, (("torque [N m]", 1.0, "turning", ORANGE, "D"),)),
    ("from the head [m]", False, (("touch [m]", 1.0, "where it lies down on the wall", GREEN, "^"),)),
    ("load on the bit [kN]", False, (("buckling [N]", 1e-3, "buckles the string at rest", RED, "s"),)),
    ("amplitude [mm]", False, (("peak amplitude [m]", 1e3, "largest of pipe 100", BLUE, "o"),)),
    ("frequency [Hz]", False, (("peak [Hz]", 1.0, "of that amplitude", BLUE, "o"),
                               ("crossover [Hz]", 1.0, "crossover from friction\nto eccentricity", GREY, "v"))),
)


def parameters(folder):
    """A column for each parameter, a row for each group of outputs; the same scale along a row."""
    sets = parameter_sets(folder)
    figure, places = plt.subplots(len(ROWS), len(sets), figsize=(20, 16), sharex="col", sharey="row",
                                  height_ratios=[1.5] + [1.0] * (len(ROWS) - 1))
    for column, (name, points) in zip(places.T, sets.items()):
        for axes, (_, _, lines) in zip(column, ROWS):
            for key, factor, label, color, marker in lines:
                axes.plot(points["value"], factor * points[key], marker + "-", color=color, markersize=4.5,
                          linewidth=1.2, label=label)
        if points["value"][-1] / points["value"][0] > 50:
            column[0].set_xscale("log")
        if name == "elements in a pipe":
            column[0].set_xticks(points["value"])
        column[-1].set_xlabel(name)
        column[0].set_title(name.split(" [")[0], fontweight="bold")
    for row, (label, logarithmic, _) in zip(places, ROWS):
        row[0].set_ylabel(label)
        if logarithmic:
            row[0].set_yscale("log")
        else:
            row[0].set_ylim(bottom=0.0)
        row[-1].legend(loc="upper left", bbox_to_anchor=(1.0, 1.0), fontsize=11)
    figure.align_ylabels(places[:, 0])
    figure.suptitle("What depends on what: one parameter changed at a time, otherwise 100 pipes of 1 m, 73 x 6 mm "
                    "steel, in a hole of 94 mm", fontsize=14, x=0.01, ha="left")
    finish(folder, figure, "parameter_studies.png")


def kinetic_energy(folder):
    if not (folder / "kinetic_energy.csv").exists():
        return
    table = columns(folder, "kinetic_energy.csv")
    time = table["time [s]"]
    drilling = time < 20.0
    cases = (("vibration", "contact, friction and vibration", ORANGE), ("friction", "contact and friction", BLUE),
             ("contact", "contact only", GREEN))
    figure, places = plt.subplots(2, 2, figsize=(13, 7), sharey="row", sharex="col")
    for column, (stage, title) in zip(places.T, ((drilling, "drilling"), (~drilling, "pulling out"))):
        for case, label, color in cases:
            more = 1e3 * (table[f"{case} mean [J]"] - table["contact mean [J]"])
            column[0].plot(time[stage], more[stage], "o-", color=color, markersize=4, label=label)
            column[1].semilogy(time[stage], table[f"{case} swing [J]"][stage], "o-", color=color, markersize=4)
        column[0].set_title(title)
        column[1].set_xlabel("time [s]")
    places[0][0].set_ylabel("mean, more than\nwith contact only [mJ]")
    places[1][0].set_ylabel("root mean square about it [J]")
    for time_of, text in ((10.0, "10 s"), (15.0, "15 s")):
        places[1][0].axvline(time_of, color=RED, linewidth=1.2, linestyle="--",
                             label="the reference: decays within 10 s,\nsettles after 15 s" if text == "10 s" else None)
    places[1][1].legend(*places[1][0].get_legend_handles_labels(), loc="upper left", bbox_to_anchor=(1.0, 1.0))
    places[0][1].legend(loc="upper left", bbox_to_anchor=(1.0, 1.0))
    figure.suptitle("Kinetic energy of pipe 100, over four revolutions each", fontsize=13, x=0.01, ha="left")
    finish(folder, figure, "kinetic_energy_of_pipe_100.png")


def main():
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    for picture in (response, modes, lengths, parameters, kinetic_energy):
        picture(pathlib.Path(sys.argv[1]))


main()
