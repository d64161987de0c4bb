#!/usr/bin/python3
"""The picture of safe_speeds: which speeds to keep away from at which depth, and why.

usage: plot.py FOLDER [DEPTH]

Reads bands.csv, severity.csv and modes.csv of the folder and writes safe_speeds.png into it. The upper part is for the
crew: green speeds are fine, yellow ones near a limit, red ones beyond it. The lower part is the Campbell diagram of one depth
(default: the one nearest to 100 m): orders of the speed against the natural frequencies they meet.
"""
import csv
import pathlib
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np
from matplotlib.colors import BoundaryNorm, ListedColormap

ORDERS = (1, 2, 3, 4)
LEVELS = (0.0, 0.5, 1.0, 2.0, 1e9)
COLOURS = ("#cfe8d5", "#fbe9a9", "#f2a65a", "#c0392b")
NAMES = ("fine", "near a limit (over half)", "avoid: beyond a limit", "avoid strictly: twice a limit and more")
KINDS = {"axial": "#1f5fa8", "torsional": "#2e7d4f", "lateral": "#9aa0a6"}

plt.rcParams.update({"figure.dpi": 110, "font.size": 12, "axes.spines.top": False, "axes.spines.right": False,
                     "figure.constrained_layout.use": True})


def rows(folder, name):
    with open(folder / name, encoding="utf-8", newline="") as text:
        return list(csv.DictReader(text))


def severity_of(folder):
    """Depths, speeds and severity of shape (speeds, depths)."""
    table = [[float(value) for value in row.values()] for row in rows(folder, "severity.csv")]
    depths = sorted({row[0] for row in table})
    speeds = sorted({row[1] for row in table})
    severity = np.zeros((len(speeds), len(depths)))
    for depth, speed, value in table:
        severity[speeds.index(speed), depths.index(depth)] = value
    return np.array(depths), np.array(speeds), severity


def edges(values):
    if len(values) == 1:
        return np.array([values[0] - 5.0, values[0] + 5.0])
    middles = 0.5 * (values[1:] + values[:-1])
    return np.concatenate([[2 * values[0] - middles[0]], middles, [2 * values[-1] - middles[-1]]])


def short(order):
    return order.split(" ", 1)[0]


def draw_map(axes, folder):
    depths, speeds, severity = severity_of(folder)
    axes.pcolormesh(edges(depths), edges(speeds), severity, cmap=ListedColormap(COLOURS),
                    norm=BoundaryNorm(LEVELS, len(COLOURS)), rasterized=True)
    for band in rows(folder, "bands.csv"):
        worst = float(band["worst [rpm]"])
        if speeds[0] + 4 < worst < speeds[-1] - 4:
            axes.text(float(band["depth [m]"]), worst, f"{short(band['order'])}\n{worst:.0f}", ha="center", va="center",
                      fontsize=8.5, color="white" if float(band["severity"]) >= 2.0 else "black")
    axes.set(xlabel="depth [m]", ylabel="speed [rpm]", xticks=depths, ylim=(speeds[0], speeds[-1]),
             title="Speeds to keep away from: order that shakes and worst speed [rpm]")
    for colour, name in zip(COLOURS, NAMES):
        axes.plot([], [], "s", markersize=11, color=colour, label=name)
    axes.legend(loc="upper center", bbox_to_anchor=(0.5, -0.13), ncol=2, frameon=False)


def draw_campbell(axes, folder, wanted):
    modes = rows(folder, "modes.csv")
    depth = min({float(row["depth [m]"]) for row in modes}, key=lambda value: abs(value - wanted))
    _, speeds, _ = severity_of(folder)
    top = ORDERS[-1] * speeds[-1] / 60.0
    drawn = set()
    for row in modes:
        frequency, kind = float(row["frequency [Hz]"]), row["kind"]
        if float(row["depth [m]"]) != depth or frequency > top:
            continue
        strong = kind != "lateral"
        axes.axhline(frequency, color=KINDS[kind], linewidth=1.8 if strong else 0.6, zorder=2 if strong else 1,
                     label=None if kind in drawn else f"natural frequency, {kind}")
        drawn.add(kind)
        for order in ORDERS:
            speed = 60.0 * frequency / order
            if strong and speeds[0] <= speed <= speeds[-1]:
                axes.plot(speed, frequency, "o", color=KINDS[kind], markersize=5, zorder=4)
    for order in ORDERS:
        axes.plot(speeds, order * speeds / 60.0, color="#b3261e", linewidth=1.4, zorder=3)
        axes.text(speeds[-1] + 2, order * speeds[-1] / 60.0, f"{order}x", color="#b3261e", va="center")
    for band in rows(folder, "bands.csv"):
        if float(band["depth [m]"]) == depth:
            axes.axvspan(float(band["low [rpm]"]), float(band["high [rpm]"]), color="#f2a65a", alpha=0.35, zorder=0)
    axes.set(xlabel="speed [rpm]", ylabel="frequency [Hz]", xlim=(speeds[0], speeds[-1]), ylim=(0, top),
             title=f"Why, at {depth:.0f} m: where orders of the speed meet natural frequencies (bands to avoid shaded)")
    axes.legend(loc="upper left", framealpha=0.95)


def main():
    if len(sys.argv) not in (2, 3):
        sys.exit(__doc__)
    folder = pathlib.Path(sys.argv[1])
    figure, (above, below) = plt.subplots(2, 1, figsize=(12, 13), height_ratios=(1.15, 1))
    draw_map(above, folder)
    draw_campbell(below, folder, float(sys.argv[2]) if len(sys.argv) == 3 else 100.0)
    figure.savefig(folder / "safe_speeds.png")


main()
