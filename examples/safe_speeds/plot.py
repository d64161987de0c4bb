#!/usr/bin/python3
"""The picture of safe_speeds: which speeds to keep away from at which depth, and why.

usage: plot.py FOLDER

Reads the tables of the folder and writes safe_speeds.png into it. The upper part is for the crew: green speeds are
fine, yellow ones near a limit, red ones beyond it. Below is the Campbell diagram of one depth: orders of the speed
against the natural frequencies that they meet, those of the string as it turns; and natural frequencies over the depth.
"""
import csv
import pathlib
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np
from matplotlib.colors import BoundaryNorm, ListedColormap
from matplotlib.patheffects import withStroke

LEVELS = (0.0, 0.5, 1.0, 2.0, 1e9)
COLOURS = ("#cfe8d5", "#fbe9a9", "#f2a65a", "#c0392b")
NAMES = ("fine", "near a limit (over half)", "avoid: beyond a limit", "avoid strictly: twice a limit and more")
KINDS = {"axial": "#1f5fa8", "torsional": "#2e7d4f", "lateral": "#9aa0a6", "forward": "#7b3fa0",
         "backward": "#b07a1e"}

WHAT = {"axial": "string stretches to and fro", "torsional": "string twists to and fro",
        "lateral": "pipes swing in the hole", "forward": "pipes whirl with the turning",
        "backward": "pipes whirl against the turning"}

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
                      fontsize=8.5, weight="bold", path_effects=[withStroke(linewidth=2.5, foreground="white")])
    axes.set(xlabel="depth [m]", ylabel="speed [rpm]", xticks=depths, ylim=(speeds[0], speeds[-1]),
             title="Speeds to keep away from: order that shakes and worst speed [rpm]")
    for colour, name in zip(COLOURS, NAMES):
        axes.plot([], [], "s", markersize=11, color=colour, label=name)
    axes.legend(loc="upper center", bbox_to_anchor=(0.5, -0.13), ncol=2, frameon=False)


def kind_of(row):
    """Sideways motion in circles is told from that to and fro."""
    if row["kind"] == "lateral" and abs(float(row["whirl"])) > 0.5:
        return "forward" if float(row["whirl"]) > 0.0 else "backward"
    return row["kind"]


def lines_of(modes):
    """Natural frequencies of a kind over the speed: the first, the second ... of each speed."""
    lines = {}
    for row in modes:
        by_speed = lines.setdefault(kind_of(row), {})
        by_speed.setdefault(float(row["speed [rpm]"]), []).append(float(row["frequency [Hz]"]))
    for kind, by_speed in lines.items():
        speeds = sorted(by_speed)
        for number in range(min(len(found) for found in by_speed.values())):
            yield kind, speeds, [sorted(by_speed[speed])[number] for speed in speeds]


def draw_crossings(axes, speeds, line, order, colour, told):
    """Dots, and their speeds but for those that would hide one told before."""
    for left, right, low, high in zip(speeds, speeds[1:], line, line[1:]):
        before, after = low - order * left / 60.0, high - order * right / 60.0
        if before * after > 0.0 or before == after:
            continue
        speed = left + (right - left) * before / (before - after)
        axes.plot(speed, order * speed / 60.0, "o", color=colour, markersize=8, zorder=5)
        frequency = order * speed / 60.0
        if any(abs(speed - x) < 25.0 and abs(frequency - y) < 1.0 for x, y in told):
            continue
        told.append((speed, frequency))
        axes.annotate(f"{speed:.0f} rpm", (speed, order * speed / 60.0), (6, -13), textcoords="offset points",
                      fontsize=10, weight="bold", color=colour, zorder=6,
                      path_effects=[withStroke(linewidth=3, foreground="white")])


def draw_campbell(axes, folder):
    modes = rows(folder, "campbell.csv")
    depth = float(modes[0]["depth [m]"])
    orders = [(float(row["order"]), row["name"]) for row in rows(folder, "orders.csv")]
    lowest, highest = (limit(float(row["speed [rpm]"]) for row in modes) for limit in (min, max))
    top = max(order for order, _ in orders) * highest / 60.0
    ends = np.array([lowest, highest])
    drawn, told = set(), []
    for kind, speeds, line in lines_of(modes):
        strong = kind != "lateral"
        axes.plot(speeds, line, color=KINDS[kind], linewidth=2.4 if strong else 0.7, zorder=3 if strong else 1,
                  label=None if kind in drawn else WHAT[kind])
        drawn.add(kind)
        for order, _ in orders:
            if strong:
                draw_crossings(axes, speeds, line, order, KINDS[kind], told)
    for order, name in orders:
        axes.plot(ends, order * ends / 60.0, color="#b3261e", linewidth=1.6, zorder=2)
        axes.text(highest + 3, order * highest / 60.0, f"{order:g}x  {name}", color="#b3261e", va="center")
    for number, band in enumerate(row for row in rows(folder, "bands.csv") if float(row["depth [m]"]) == depth):
        axes.axvspan(float(band["low [rpm]"]), float(band["high [rpm]"]), color="#f2a65a", alpha=0.35, zorder=0,
                     label="speeds to keep away from" if number == 0 else None)
    axes.set(xlabel="speed [rpm]", ylabel="frequency [Hz]", xlim=(lowest, highest), ylim=(0, top),
             title=f"Why, at {depth:.0f} m: what shakes (red) meets a natural frequency of the turning string")
    axes.legend(loc="upper center", bbox_to_anchor=(0.5, -0.12), ncol=2, frameon=False)


def draw_depths(axes, folder):
    modes = rows(folder, "modes.csv")
    depths = sorted({float(row["depth [m]"]) for row in modes})
    for kind in ("lateral", "torsional", "axial"):
        found = [row for row in modes if row["kind"] == kind]
        axes.plot([float(row["depth [m]"]) for row in found], [float(row["frequency [Hz]"]) for row in found],
                  "_" if kind == "lateral" else "o", color=KINDS[kind], markersize=6 if kind == "lateral" else 7,
                  zorder=1 if kind == "lateral" else 2, label=WHAT[kind])
    axes.set(xlabel="depth [m]", ylabel="frequency [Hz]", xticks=depths, ylim=(0, None),
             title="Natural frequencies over the depth")


def main():
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    folder = pathlib.Path(sys.argv[1])
    figure, (crew, campbell, depths) = plt.subplots(3, 1, figsize=(12, 18), height_ratios=(1.15, 1, 0.75))
    draw_map(crew, folder)
    draw_campbell(campbell, folder)
    draw_depths(depths, folder)
    figure.savefig(folder / "safe_speeds.png")


main()
