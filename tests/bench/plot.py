#!/usr/bin/python3
"""Pictures of the benchmark. usage: plot.py RESULTS.CSV FOLDER

Writes work_against_error.png and real_time_factor.png into FOLDER; a picture without rows is left out.
"""
import csv
import math
import pathlib
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt

BLUE, ORANGE, GREEN, RED, GREY = "#1f5fa8", "#d9730d", "#2e7d4f", "#b3261e", "#6b7280"
COLOURS = {"C": BLUE, "B": GREEN, "R": ORANGE}
TITLES = {"C": "C: turning tube", "B": "B: on the wall", "R": "R: rig cycle"}
ERRORS = {"C": ("error", "tip speed at 2 s [-]"), "B": ("error", "tip rotation at 0.1 s [-]"),
          "R": ("error", "torque at 0.5 s [-]")}

plt.rcParams.update({
    "figure.dpi": 100, "font.size": 10.5, "font.family": "DejaVu Sans", "axes.titlesize": 11, "axes.labelsize": 10.5,
    "axes.spines.top": False, "axes.spines.right": False, "axes.grid": True, "grid.color": "#dddddd",
    "grid.linewidth": 0.6, "axes.axisbelow": True, "legend.frameon": False, "legend.fontsize": 10,
    "figure.constrained_layout.use": True})


def read(path):
    with open(path, encoding="utf-8", newline="") as text:
        return list(csv.DictReader(line for line in text if not line.startswith("#")))


def step_text(row):
    return f"{1e3 * float(row['dt']):g} ms"


def tolerance_text(row):
    return f"$10^{{{math.log10(float(row['tolerance'])):.0f}}}$ rad"


def draw_work(axes, rows, scene):
    column, label = ERRORS[scene]
    for method, marker, dashes, text in (("fixed", "o", "-", "fixed step"),
                                         ("controlled", "s", "--", "error-controlled")):
        chosen = [row for row in rows if row["scene"] == scene and row["method"] == method]
        x = [float(row[column]) for row in chosen]
        y = [float(row["us_per_simulated_second"]) for row in chosen]
        axes.loglog(x, y, dashes, marker=marker, markersize=5, linewidth=1.5, label=text,
                    color=COLOURS[scene] if method == "fixed" else GREY)
        if not chosen:
            continue
        for i in (0, len(chosen) - 1):
            name = step_text(chosen[i]) if method == "fixed" else tolerance_text(chosen[i])
            right = (method == "controlled") != (scene == "B")  # away from the other line
            axes.annotate(name, (x[i], y[i]), xytext=(7 if right else -7, -3), textcoords="offset points", fontsize=8.5,
                          color=COLOURS[scene] if method == "fixed" else GREY, ha="left" if right else "right")
    axes.axhline(1e6, color=RED, linewidth=1)
    axes.set_title(TITLES[scene], loc="left", fontweight="bold")
    axes.set_xlabel("relative error,\n" + label)
    axes.margins(x=0.62, y=0.08)
    axes.legend(loc="upper center", bbox_to_anchor=(0.5, -0.26), borderaxespad=0.0)


def work_against_error(rows, folder):
    rows = [row for row in rows if row["group"] == "work"]
    scenes = [scene for scene in ("C", "B", "R") if any(row["scene"] == scene for row in rows)]
    if not scenes:
        return
    figure, axes = plt.subplots(1, len(scenes), figsize=(8, 4.4), sharey=True, squeeze=False)
    figure.suptitle("Work against error, 100 pipes of 1 m", fontsize=13, x=0.01, ha="left")
    for place, scene in zip(axes[0], scenes):
        draw_work(place, rows, scene)
    axes[0][0].set_ylabel("computing [µs] for a simulated second")
    axes[0][-1].annotate("real time", (0.98, 1e6), xycoords=("axes fraction", "data"), xytext=(0, 3), ha="right",
                         textcoords="offset points", fontsize=8.5, color=RED)
    save(figure, folder / "work_against_error.png")


def real_time_factor(rows, folder):
    rows = [row for row in rows if row["group"] == "pipes"]
    if not rows:
        return
    figure, axes = plt.subplots(figsize=(8, 4.4))
    axes.set_title("Real-time factor, 1 ms steps, one core", fontsize=13, loc="left")
    for scene, text in (("C", "C: turning tube"), ("R", "R: rig cycle, everything on")):
        chosen = [row for row in rows if row["scene"] == scene]
        if not chosen:
            continue
        x = [int(row["pipes"]) for row in chosen]
        y = [float(row["rtf"]) for row in chosen]
        axes.loglog(x, y, "o-", color=COLOURS[scene], linewidth=1.8, label=text)
        for i, row in enumerate(chosen):
            axes.annotate(f"{y[i]:.2g}×\nerror {float(row['error']):.0e}", (x[i], y[i]),
                          xytext=(0, 8) if scene == "C" else (0, -26), textcoords="offset points", fontsize=8.5,
                          color=COLOURS[scene], ha="center")
    axes.axhline(1.0, color=RED, linewidth=1.2)
    axes.annotate("real time", (0.005, 1.0), xycoords=("axes fraction", "data"), xytext=(0, 3),
                  textcoords="offset points", fontsize=9, color=RED)
    ticks = sorted({int(row["pipes"]) for row in rows})
    axes.set_xticks(ticks, [str(tick) for tick in ticks])
    axes.set_yticks([0.5, 1, 2, 5, 10, 20, 50])
    axes.minorticks_off()
    axes.yaxis.set_major_formatter(matplotlib.ticker.FuncFormatter(lambda value, _: f"{value:g}"))
    axes.set_xlabel("pipes of 1 m  (error: C tip speed at 2 s, R torque at 0.5 s, relative)")
    axes.set_ylabel("simulated time / computing time")
    axes.margins(x=0.1, y=0.18)
    axes.legend(loc="upper right")
    save(figure, folder / "real_time_factor.png")


def save(figure, path):
    figure.savefig(path)
    plt.close(figure)
    print(f"  {path.name}")


def main():
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    rows, folder = read(sys.argv[1]), pathlib.Path(sys.argv[2])
    work_against_error(rows, folder)
    real_time_factor(rows, folder)


main()
