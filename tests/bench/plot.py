#!/usr/bin/python3
"""Pictures of the benchmark. usage: plot.py FOLDER SCENE...

Reads FOLDER/SCENE.csv; work_against_error.png of scene W, on_the_average.png of M and real_time_factor.png of C and R,
into FOLDER.
"""
import pathlib
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt

import rows as measured

BLUE, ORANGE, RED = "#1f5fa8", "#d9730d", "#b3261e"
COLOURS = {"C": BLUE, "R": ORANGE}
PANELS = {"C": "C: turning tube, 0.8 s", "T": "T: bending down 20 m, turning, 0.8 s",
          "B": "B: falling onto the wall, 0.1 s", "R": "R: rig cycle, 0.4 s"}
MEASURES = {"C": "tip speed, relative", "T": "tip's place over the length", "B": "tip's place over the clearance",
            "R": "torque, relative"}
# setting: text, colour, line, marker
SETTINGS = {"default": ("default: fixed steps, radius 0.8, 1 element a pipe", BLUE, "-", "o"),
            "controlled": ("error-controlled", RED, "--", "s"),
            "radius_1": ("spectral radius 1", "#0b7a75", "-", "^"),
            "radius_0.9": ("spectral radius 0.9", "#5aa469", ":", "v"),
            "radius_0.5": ("spectral radius 0.5", "#b08900", ":", "<"),
            "radius_0": ("spectral radius 0", "#d9730d", "-", ">"),
            "elements_2": ("2 elements a pipe", "#9a6fb0", "-", "D"),
            "elements_4": ("4 elements a pipe", "#5b3a86", "-", "P"),
            "axial_torsional": ("axial-torsional elements", "#444444", "-.", "X")}

plt.rcParams.update({
    "figure.dpi": 100, "font.size": 10.5, "font.family": "DejaVu Sans", "axes.titlesize": 11, "axes.labelsize": 10.5,
    "axes.spines.top": False, "axes.spines.right": False, "axes.grid": True, "grid.color": "#dddddd",
    "grid.linewidth": 0.6, "axes.axisbelow": True, "legend.frameon": False, "legend.fontsize": 10,
    "figure.constrained_layout.use": True})


def draw_work(axes, rows, scene):
    for setting, (text, colour, dashes, marker) in SETTINGS.items():
        chosen = measured.chosen(rows, scene=scene, setting=setting)
        if not chosen:
            continue
        strong = setting in ("default", "controlled")
        axes.loglog([float(row["error"]) for row in chosen], [float(row["U_per_simulated_second"]) for row in chosen],
                    dashes, marker=marker, markersize=6 if strong else 4.5, linewidth=2 if strong else 1.2, label=text,
                    color=colour, zorder=3 if strong else 2)
        if setting == "default":
            for row, place in ((chosen[0], (-8, -13)), (chosen[-1], (8, 4))):
                axes.annotate(f"{1e3 * float(row['dt']):.4g} ms",
                              (float(row["error"]), float(row["U_per_simulated_second"])), xytext=place,
                              textcoords="offset points", fontsize=9, color=colour)
    reference = max(float(row["reference_error"]) for row in measured.chosen(rows, scene=scene))
    left, right = axes.get_xlim()
    if reference > 0.0:
        left = min(left, 0.3 * reference)
        axes.axvspan(left, reference, color="#eeeeee", zorder=0)
    axes.set_xlim(left, right)
    axes.set_title(PANELS[scene], loc="left", fontweight="bold")
    axes.set_xlabel("error: " + MEASURES[scene])


def work_against_error(rows, folder):
    scenes = [scene for scene in PANELS if measured.chosen(rows, scene=scene)]
    if not scenes:
        return
    figure, axes = plt.subplots(2, 2, figsize=(10, 9))
    figure.suptitle("Work against error, steps from 4 ms down; grey: below the error of the reference", fontsize=13,
                    x=0.01, ha="left")
    for place, scene in zip(axes.flat, scenes):
        draw_work(place, rows, scene)
    for place in axes[:, 0]:
        place.set_ylabel("work: U for a simulated second")
    handles = {}
    for place in axes.flat:
        handles.update(zip(*reversed(place.get_legend_handles_labels())))
    figure.legend(handles.values(), handles.keys(), loc="lower center", ncols=3)
    figure.get_layout_engine().set(rect=(0, 0.1, 1, 0.9))
    save(figure, folder / "work_against_error.png")


def draw_mean(axes, rows, column, stretch):
    groups = (("fixed steps", BLUE, "o-", lambda row: not row["tolerance"] and row["radius"] == "0.8" and
               row["elements_per_pipe"] == "1"),
              ("error-controlled, mean step", RED, "s", lambda row: row["tolerance"]),
              ("other spectral radii", ORANGE, "^", lambda row: row["radius"] != "0.8"),
              ("2 and 4 elements a pipe", "#5b3a86", "D", lambda row: row["elements_per_pipe"] != "1"))
    for text, colour, style, belongs in groups:
        own = [row for row in rows if belongs(row)]
        axes.errorbar([1e3 * float(row["dt"]) for row in own], [float(row[stretch + column]) for row in own],
                      yerr=[float(row[stretch + column + "_error"]) for row in own], fmt=style, markersize=5,
                      linewidth=1.2, capsize=3, color=colour, label=text)
    axes.set_xscale("log")
    ticks = sorted({1e3 * float(row["dt"]) for row in rows if not row["tolerance"]})
    axes.set_xticks(ticks, [f"{tick:g}" for tick in ticks])
    axes.minorticks_off()
    axes.ticklabel_format(axis="y", useOffset=False)


def on_the_average(rows, folder):
    columns = (("force", "sum of wall forces [N]"), ("torque", "torque of the drive [N m]"),
               ("sideways_mm", "sideways, r.m.s. [mm]"))
    stretches = (("chatter_", "0.1 to 1.1 s"), ("", "2 to 3 s"))
    figure, axes = plt.subplots(2, 3, figsize=(11, 6.4))
    figure.suptitle("B on the average: four starts, mean and its standard error, against the step", fontsize=13,
                    x=0.01, ha="left")
    for line, (stretch, when) in zip(axes, stretches):
        for place, (column, label) in zip(line, columns):
            draw_mean(place, rows, column, stretch)
            place.set_title(f"{label}, {when}", loc="left", fontsize=10)
    for place in axes[1]:
        place.set_xlabel("step [ms]")
    handles, labels = axes[0][0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="lower center", ncols=4)
    figure.get_layout_engine().set(rect=(0, 0.06, 1, 0.94))
    save(figure, folder / "on_the_average.png")


def real_time_factor(rows, folder):
    rows = measured.chosen(rows, group="pipes")
    if not rows:
        return
    figure, axes = plt.subplots(figsize=(8, 4.4))
    axes.set_title("Real-time factor, 1 ms steps, one core", fontsize=13, loc="left")
    for scene, text in (("C", "C: turning tube"), ("R", "R: rig cycle, everything on")):
        chosen = measured.chosen(rows, scene=scene)
        if not chosen:
            continue
        x = [int(row["pipes"]) for row in chosen]
        y = [float(row["rtf"]) for row in chosen]
        axes.loglog(x, y, "o-", color=COLOURS[scene], linewidth=1.8, label=text)
        for i, row in enumerate(chosen):
            axes.annotate(f"{y[i]:.{max(2, len(str(int(y[i]))))}g}×\nerror {float(row['error']):.0e}", (x[i], y[i]),
                          xytext=(0, 8) if scene == "C" else (0, -26), textcoords="offset points", fontsize=8.5,
                          color=COLOURS[scene], ha="center")
    axes.axhline(1.0, color=RED, linewidth=1.2)
    axes.annotate("real time", (0.005, 1.0), xycoords=("axes fraction", "data"), xytext=(0, 3),
                  textcoords="offset points", fontsize=9, color=RED)
    ticks = sorted({int(row["pipes"]) for row in rows})
    axes.set_xticks(ticks, [str(tick) for tick in ticks])
    largest = max(float(row["rtf"]) for row in rows)
    axes.set_yticks([tick for tick in (0.5, 1, 2, 5, 10, 20, 50, 100, 200, 500) if tick < 2 * largest])
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
    if len(sys.argv) < 3:
        sys.exit(__doc__)
    folder, scenes = pathlib.Path(sys.argv[1]), sys.argv[2:]
    if "W" in scenes:
        work_against_error(measured.read(folder, "W"), folder)
    if "M" in scenes:
        on_the_average(measured.read(folder, "M"), folder)
    real_time_factor([row for scene in ("C", "R") if scene in scenes for row in measured.read(folder, scene)], folder)


main()
