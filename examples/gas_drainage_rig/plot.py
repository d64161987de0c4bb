#!/usr/bin/python3
"""Pictures of a run of gas_drainage_rig.

usage: plot.py FOLDER

Reads summary.json and the tables beside it, and writes PNG pictures into the same folder: displacements, speeds and
kinetic energy, each over the whole cycle and, to the right, over three revolutions in the middle of drilling. Pictures
whose variants were not run are left out.
"""
import csv
import json
import pathlib
import sys

import matplotlib
import matplotlib.ticker

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

BLUE, ORANGE, GREEN, RED, GREY = "#1f5fa8", "#d9730d", "#2e7d4f", "#b3261e", "#6b7280"
POINTS = 1500  # a line has at most this many lows and highs: more than the picture has pixels
CASES = (("flexible-vibration", "contact + friction + vibration", ORANGE),
         ("flexible-friction", "contact + friction", BLUE),
         ("flexible-contact", "contact only", GREEN))

plt.rcParams.update({
    "figure.dpi": 100, "font.size": 11, "font.family": "DejaVu Sans", "axes.titlesize": 11, "axes.labelsize": 11,
    "axes.spines.top": False, "axes.spines.right": False, "axes.grid": True, "grid.color": "#dddddd",
    "grid.linewidth": 0.6, "axes.axisbelow": True, "legend.frameon": False, "legend.fontsize": 10.5,
    "axes.formatter.useoffset": False})


# ---- Data -----------------------------------------------------------------------------------------------------------

class Variant:
    """One table, column by column."""

    def __init__(self, folder, description):
        self.summary = description
        path = folder / description["table"]
        with open(path, encoding="utf-8", newline="") as text:
            names = next(csv.reader(text))
        table = np.loadtxt(path, delimiter=",", skiprows=1, ndmin=2)
        self.columns = dict(zip(names, table.T))
        self.time = self.columns["time [s]"]

    def column(self, start):
        return next(values for name, values in self.columns.items() if name.startswith(start))

    def pipe(self, quantity, number):
        return self.column(f"{quantity} of string 0 pipe {number - 1} at 1 ")

    def bit(self, quantity):
        return self.column(f"{quantity} of bit 0")


class Run:
    def __init__(self, folder):
        self.folder = folder
        self.summary = json.loads((folder / "summary.json").read_text(encoding="utf-8"))
        self.variants = {each["name"]: Variant(folder, each) for each in self.summary["variants"]}
        self.end = self.summary["end"]
        self.stages = [each for each in self.summary["stages"] if each["from"] < self.end]

    def main(self):
        """The variant that single-case pictures show: the fullest one there is."""
        for name, _, _ in CASES:
            if name in self.variants:
                return self.variants[name]
        return next(iter(self.variants.values()), None)

    def closer_look(self):
        """Three revolutions in the middle of drilling, or the last part of a run that ends before."""
        drill = self.stages[min(1, len(self.stages) - 1)]
        begin, end = drill["from"], min(drill["to"], self.end)
        length = min(0.9, 0.5 * (end - begin))
        middle = 0.5 * (begin + end)
        return middle - 0.5 * length, middle + 0.5 * length


def decimated(time, values, begin, end):
    """The samples from begin to end; of each short stretch the least and the most, in the order in which they come, so
    that no peak is lost."""
    inside = (time >= begin - 1e-9) & (time <= end + 1e-9)
    time, values = time[inside], values[inside]
    stretch = len(time) // POINTS
    if stretch < 3:
        return time, values
    whole = len(time) // stretch * stretch
    folded = values[:whole].reshape(-1, stretch)
    start = np.arange(0, whole, stretch)
    pick = np.sort(np.stack([folded.argmin(axis=1) + start, folded.argmax(axis=1) + start]), axis=0).T.ravel()
    pick = np.unique(np.concatenate([pick, np.arange(whole, len(time))]))
    return time[pick], values[pick]


def running_mean(time, values, width):
    """Over a window of the given width, cut off at both ends of the run."""
    half = int(round(0.5 * width / (time[1] - time[0]))) if len(time) > 1 else 0
    total = np.concatenate([[0.0], np.cumsum(values)])
    first = np.maximum(np.arange(len(values)) - half, 0)
    last = np.minimum(np.arange(len(values)) + half + 1, len(values))
    return (total[last] - total[first]) / (last - first)


# ---- Drawing --------------------------------------------------------------------------------------------------------

def letter_of(number):
    return "abcdefghijklmnopqrstuvwxyz"[number % 26]


def shade_stages(axes, run, named):
    """Bands behind the drawing: the stages. Their letters stand above the topmost one, what they mean below them all
    (stage_key)."""
    for i, stage in enumerate(run.stages):
        end = min(stage["to"], run.end)
        if i % 2 == 0:
            axes.axvspan(stage["from"], end, color="#eef1f5", zorder=0, linewidth=0)
        if named:
            axes.annotate(letter_of(i), (0.5 * (stage["from"] + end), 1.0), xycoords=("data", "axes fraction"),
                          xytext=(0, 3), textcoords="offset points", ha="center", va="bottom", fontsize=10, color=GREY)
    axes.set_xlim(0.0, run.end)


def stage_key(figure, run):
    names = ",  ".join(f"{letter_of(i)}: {stage['name']}" for i, stage in enumerate(run.stages))
    figure.supxlabel(f"stages  {names}", x=0.01, ha="left", fontsize=10, color=GREY)


def draw(axes, variant, values, begin, end, color, label=None, width=0.9, **more):
    time, values = decimated(variant.time, values, begin, end)
    axes.plot(time, values, color=color, linewidth=width, label=label, **more)


def set_margins(figure, left, right, bottom, top, **gaps):
    """Margins in inches. Fixed ones take half the time of a layout by matplotlib."""
    width, height = figure.get_size_inches()
    figure.subplots_adjust(left=left / width, right=1.0 - right / width, bottom=bottom / height, top=1.0 - top / height,
                           **gaps)


def panels(rows, title, subtitle="", height=2.1):
    """Rows of a whole cycle and a closer look."""
    figure, axes = plt.subplots(rows, 2, figsize=(12.5, 1.6 + height * rows), sharex="col", squeeze=False,
                                gridspec_kw={"width_ratios": [2.4, 1]})
    figure.suptitle(title + (f"\n{subtitle}" if subtitle else ""), fontsize=13, x=0.01, ha="left")
    set_margins(figure, 1.35, 0.15, 0.85, 0.85, wspace=0.16, hspace=0.12)
    return figure, axes


def finish(run, figure, axes, name):
    begin, end = run.closer_look()
    for row, (whole, close) in enumerate(axes):
        shade_stages(whole, run, row == 0)
        whole.axvspan(begin, end, color="#f3d9a4", alpha=0.8, zorder=0, linewidth=0)
        close.set_xlim(begin, end)
        close.set_facecolor("#fdf7ea")
    axes[0][1].set_title("closer look", fontsize=10, color=GREY)
    axes[-1][0].set_xlabel("time [s]")
    axes[-1][1].set_xlabel("time [s]")
    stage_key(figure, run)
    figure.align_ylabels(axes[:, 0])
    figure.savefig(run.folder / name)
    plt.close(figure)
    print(f"  {name}")


def same_span(axes):
    """The same millimetres in the same height, so that panels can be compared by eye."""
    limits = [each.get_ylim() for each in axes]
    span = max(high - low for low, high in limits)
    for each, (low, high) in zip(axes, limits):
        each.set_ylim(0.5 * (low + high - span), 0.5 * (low + high + span))


def legend_below(lowest, axes):
    handles, labels = axes.get_legend_handles_labels()
    legend = lowest.legend(handles, labels, loc="upper left", bbox_to_anchor=(0.0, -0.2), ncol=len(labels))
    for handle in legend.get_lines():
        handle.set_linewidth(2.5)


def signals(run, name, title, rows):
    """One row of panels for each (label, unit, values, color) of the main variant."""
    variant = run.main()
    figure, axes = panels(len(rows), title, case_of(variant))
    for (label, unit, values, color), (whole, close) in zip(rows, axes):
        draw(whole, variant, values, 0.0, run.end, color)
        draw(close, variant, values, *run.closer_look(), color, width=1.3)
        whole.set_ylabel(f"{label}\n[{unit}]")
    finish(run, figure, axes, name)


def case_of(variant):
    texts = {name: text for name, text, _ in CASES}
    name = variant.summary["name"]
    return "flexible pipes, " + texts[name] if name in texts else name


# ---- The pictures ---------------------------------------------------------------------------------------------------

def bit_displacement(run):
    cases = [(run.variants[name], text, color) for name, text, color in (
        ("rigid-vibration", "rigid string", RED), ("flexible-vibration", "flexible string", BLUE))
        if name in run.variants]
    if len(cases) < 2:
        return
    figure, axes = panels(len(cases), "Bit: vertical displacement (Z)",
                          "contact + friction + vibration", height=2.4)
    for (variant, text, color), (whole, close) in zip(cases, axes):
        values = 1e3 * variant.bit("displacement_z")
        draw(whole, variant, values, 0.0, run.end, color)
        draw(close, variant, values, *run.closer_look(), color, width=1.3)
        whole.set_ylabel(f"{text}\n[mm]")
    same_span([whole for whole, _ in axes])
    finish(run, figure, axes, "a_bit_z_displacement_rigid_and_flexible.png")


def kinetic_energy(run):
    cases = [(run.variants[name], text, color) for name, text, color in CASES if name in run.variants]
    if len(cases) < 2:
        return
    last = cases[0][0].summary["pipes"][2]
    figure, axes = panels(2, f"Kinetic energy of pipe {last}", "flexible pipes", height=2.9)
    set_margins(figure, 1.35, 0.15, 1.25, 0.85)
    reference = cases[-1][0]
    for variant, text, color in cases:
        values = variant.column("kinetic_energy")
        draw(axes[0][0], variant, values, 0.0, run.end, color, text)
        draw(axes[0][1], variant, values, *run.closer_look(), color, width=1.4)
        if variant is reference or len(values) != len(reference.time):
            continue
        more = 1e3 * running_mean(variant.time, values - reference.column("kinetic_energy"), 1.2)
        draw(axes[1][0], variant, more, 0.0, run.end, color)
        draw(axes[1][1], variant, more, *run.closer_look(), color, width=1.4)
    axes[0][0].set_ylabel("kinetic energy\n[J]")
    axes[1][0].set_ylabel(f"more than {cases[-1][1]},\nmean of 4 revolutions [mJ]")
    axes[1][0].axhline(0.0, color=GREEN, linewidth=1.2)
    axes[1][1].axhline(0.0, color=GREEN, linewidth=1.2)
    legend_below(axes[1][0], axes[0][0])
    finish(run, figure, axes, f"b_kinetic_energy_of_pipe_{last}.png")


def first_pipe_speeds(run):
    variant = run.main()
    first = variant.summary["pipes"][0]
    signals(run, f"c_speeds_of_pipe_{first}.png", f"Pipe {first}: speeds of its far end",
            [(f"{axis} ({text})", "mm/s", 1e3 * variant.pipe(f"velocity_{axis.lower()}", first), color)
             for axis, text, color in (("X", "along", BLUE), ("Y", "sideways", ORANGE), ("Z", "up", GREEN))])


def speeds_up(run):
    variant = run.main()
    numbers = variant.summary["pipes"]
    signals(run, "d_z_speed_of_pipes_" + "_".join(map(str, numbers)) + ".png", "Vertical speed (Z) of three pipes",
            [(f"pipe {number}", "mm/s", 1e3 * variant.pipe("velocity_z", number), color)
             for number, color in zip(numbers, (BLUE, ORANGE, GREEN))])


def first_pipe_displacements(run):
    variant = run.main()
    first = variant.summary["pipes"][0]
    signals(run, f"e_y_and_z_displacement_of_pipe_{first}.png", f"Pipe {first}: displacement of its far end",
            [(f"{axis} ({text})", "mm", 1e3 * variant.pipe(f"displacement_{axis.lower()}", first), color)
             for axis, text, color in (("Y", "sideways", ORANGE), ("Z", "up", GREEN))])


def displacements_up(run):
    variant = run.main()
    numbers = variant.summary["pipes"]
    signals(run, "f_z_displacement_of_pipes_" + "_".join(map(str, numbers)) + ".png",
            "Vertical displacement (Z) of three pipes",
            [(f"pipe {number}", "mm", 1e3 * variant.pipe("displacement_z", number), color)
             for number, color in zip(numbers, (BLUE, ORANGE, GREEN))])


def strips(figure, cell, run, title, unit, lines, first):
    """One strip for each (variant, values, color, label), one below the other to one scale, so that none hides
    another."""
    grid = cell.subgridspec(len(lines), 1, hspace=0.0)
    axes = []
    for row, (variant, values, color, label) in enumerate(lines):
        place = figure.add_subplot(grid[row], sharex=axes[0] if axes else None)
        draw(place, variant, values, 0.0, run.end, color)
        shade_stages(place, run, first and row == 0)
        place.annotate(label, (1.0, 0.5), xycoords="axes fraction", xytext=(5, 0), textcoords="offset points",
                       ha="left", va="center", fontsize=10, color=color)
        place.tick_params(labelbottom=row + 1 == len(lines), labelsize=9)
        place.yaxis.set_major_locator(matplotlib.ticker.MaxNLocator(4 if len(lines) < 3 else 3, prune="both"))
        axes.append(place)
    same_span(axes)
    axes[0].set_title(title, loc="left", pad=20 if first else 5, fontweight="bold")
    axes[len(axes) // 2].set_ylabel(f"[{unit}]")
    return axes


def overview(run):
    """Motion and forces of the head, and the pictures above in small."""
    variant = run.main()
    numbers = variant.summary["pipes"]
    figure = plt.figure(figsize=(15, 17))
    figure.suptitle(f"Gas drainage rig: {run.summary['pipes']} pipes of {run.summary['pipe_length']:g} m, "
                    f"step {1e3 * run.summary['step']:g} ms", fontsize=15, x=0.01, ha="left")
    set_margins(figure, 0.85, 1.05, 0.85, 1.2, wspace=0.3, hspace=0.3)
    grid = figure.add_gridspec(4, 2)
    cases = [(run.variants[name], color, text.replace(" + ", "\n+ "))
             for name, text, color in CASES if name in run.variants]

    def of_cases(column):
        return [(case, case.column(column), color, text) for case, color, text in cases]

    def of_pipes(quantity, factor):
        return [(variant, factor * variant.pipe(quantity, number), color, f"pipe {number}")
                for number, color in zip(numbers, (BLUE, ORANGE, GREEN))]

    def of_axes(quantity, axes):
        return [(variant, 1e3 * variant.pipe(f"{quantity}_{axis}", numbers[0]), color, axis.upper())
                for axis, color in axes]

    bit = [(run.variants[name], 1e3 * run.variants[name].bit("displacement_z"), color, text)
           for name, text, color in (("rigid-vibration", "rigid\nstring", RED),
                                     ("flexible-vibration", "flexible\nstring", BLUE)) if name in run.variants]
    cells = [
        [("Rotation torque of the head", "N m", of_cases("drive_force of drive 1")),
         ("Feed force of the head", "kN", [(variant, 1e-3 * variant.column("drive_force of drive 0"), BLUE, "")])],
        [("Bit, Z displacement", "mm", bit or [(variant, 1e3 * variant.bit("displacement_z"), BLUE, "")]),
         (f"Kinetic energy of pipe {numbers[2]}", "J",
          of_cases("kinetic_energy") or [(variant, variant.column("kinetic_energy"), BLUE, "")])],
        [("Z displacement", "mm", of_pipes("displacement_z", 1e3)), ("Z speed", "mm/s", of_pipes("velocity_z", 1e3))],
        [(f"Pipe {numbers[0]}, displacement", "mm", of_axes("displacement", (("y", ORANGE), ("z", GREEN)))),
         (f"Pipe {numbers[0]}, speed", "mm/s", of_axes("velocity", (("x", BLUE), ("y", ORANGE), ("z", GREEN))))]]
    for row, pair in enumerate(cells):
        for column, (title, unit, lines) in enumerate(pair):
            axes = strips(figure, grid[row, column], run, title, unit, lines, row == 0)
            if row + 1 == len(cells):
                axes[-1].set_xlabel("time [s]")
    stage_key(figure, run)
    figure.savefig(run.folder / "overview.png")
    plt.close(figure)
    print("  overview.png")


def main():
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    run = Run(pathlib.Path(sys.argv[1]))
    if run.main() is None:
        sys.exit("no variant came to its end, nothing to draw")
    for picture in (bit_displacement, kinetic_energy, first_pipe_speeds, speeds_up, first_pipe_displacements,
                    displacements_up, overview):
        picture(run)


main()
