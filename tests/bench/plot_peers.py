#!/usr/bin/python3
"""Work against error, the library and SUNDIALS on the same equations. usage: plot_peers.py PEERS.CSV FOLDER

Writes peers_work.png into FOLDER; without rows of both scenes nothing.
"""
import csv
import pathlib
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt

plt.rcParams.update({
    "figure.dpi": 100, "font.size": 10.5, "font.family": "DejaVu Sans", "axes.spines.top": False,
    "axes.spines.right": False, "axes.grid": True, "grid.color": "#dddddd", "grid.linewidth": 0.6,
    "axes.axisbelow": True, "legend.frameon": False, "figure.constrained_layout.use": True})

# code, what its setting holds, colour, marker, name
LINES = (("drillmbd", ("dt=",), "#1f5fa8", "o", "library, fixed steps"),
         ("drillmbd", ("tolerance=",), "#6ba3d6", "s", "library, error-controlled"),
         ("IDA", ("order=2", "blocks"), "#d9730d", "^", "IDA, order up to 2"),
         ("IDA", ("order=5", "blocks"), "#b3261e", "v", "IDA, order up to 5"),
         ("ARKODE", ("order=3",), "#2e7d4f", "D", "ARKODE, order 3"),
         ("ARKODE", ("order=5",), "#7fb069", "P", "ARKODE, order 5"))
SCENES = (("C", "C: turning tube", "tip speed at 2 s [-]"), ("B", "B: on the wall", "tip rotation at 0.1 s [-]"))


def draw(axes, rows, column):
    for code, words, colour, marker, name in LINES:
        chosen = [row for row in rows if row["code"] == code and all(word in row["setting"] for word in words)]
        axes.loglog([float(row["error"]) for row in chosen], [float(row[column]) for row in chosen], "-", color=colour,
                    marker=marker, markersize=5, linewidth=1.4, label=name)


def main():
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    with open(sys.argv[1], encoding="utf-8", newline="") as text:
        rows = list(csv.DictReader(line for line in text if not line.startswith("#")))
    rows = [row for row in rows if row["error_kind"].endswith("IDA_1e-10")]
    if {row["scene"] for row in rows} != {"C", "B"}:
        return
    figure, axes = plt.subplots(1, 2, figsize=(8, 4.6), sharey=True)
    figure.suptitle("The same equations, other integrators: 100 elements", fontsize=13, x=0.01, ha="left")
    for place, (scene, title, label) in zip(axes, SCENES):
        draw(place, [row for row in rows if row["scene"] == scene], "U_per_simulated_second")
        place.set_title(title, loc="left", fontweight="bold", fontsize=11)
        place.set_xlabel("relative error,\n" + label)
    axes[0].set_ylabel("computing [U] for a simulated second")
    figure.get_layout_engine().set(rect=(0, 0.13, 1, 0.87))  # room for the legend
    figure.legend(*axes[0].get_legend_handles_labels(), loc="lower center", ncols=3, fontsize=9.5)
    figure.savefig(pathlib.Path(sys.argv[2]) / "peers_work.png")


main()
