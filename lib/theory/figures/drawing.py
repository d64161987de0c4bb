"""Shared by the scripts of figures: style, axes for drawings, arrows, frames. Each script writes the file that its only
argument names; the ending decides the format (svg in pages, pdf in print, png for a look)."""
import sys

import matplotlib
matplotlib.use("Agg")
import matplotlib.pyplot as plt

INK, GREY, LIGHT = "#1a1a1a", "#7a7a7a", "#d9d9d9"
BLUE, RED, GREEN, ORANGE = "#0b4f8a", "#b5301f", "#2c7a3f", "#c77700"

plt.rcParams.update({"font.size": 10, "font.family": "serif", "mathtext.fontset": "cm", "svg.hashsalt": "drillmbd",
                     "svg.fonttype": "path", "axes.spines.top": False, "axes.spines.right": False,
                     "axes.edgecolor": GREY, "lines.linewidth": 1.4})


def sketch(width=6.0, height=3.0):
    """A figure for a drawing: equal scales, no axes."""
    figure, axes = plt.subplots(figsize=(width, height))
    axes.set_aspect("equal")
    axes.axis("off")
    return figure, axes


def graph(width=5.6, height=3.0, **options):
    """A figure for curves."""
    return plt.subplots(figsize=(width, height), **options)


def arrow(axes, begin, end, text="", colour=INK, at=None, **options):
    """An arrow with its text at `at` (default: beyond its head)."""
    axes.annotate("", xy=end, xytext=begin, zorder=5,
                  arrowprops={"arrowstyle": "-|>", "color": colour, "lw": 1.3, "shrinkA": 0, "shrinkB": 0, **options})
    if text:
        dx, dy = end[0] - begin[0], end[1] - begin[1]
        long = max((dx * dx + dy * dy) ** 0.5, 1e-12)
        place = at if at is not None else (end[0] + 0.12 * dx / long, end[1] + 0.12 * dy / long)
        axes.text(*place, text, color=colour, ha="center", va="center", zorder=6)


def dimension(axes, begin, end, text, colour=GREY, offset=(0, 0.12)):
    """A length between two points, with arrows at both ends."""
    axes.annotate("", xy=end, xytext=begin, arrowprops={"arrowstyle": "<->", "color": colour, "lw": 0.9, "shrinkA": 0,
                                                        "shrinkB": 0})
    axes.text((begin[0] + end[0]) / 2 + offset[0], (begin[1] + end[1]) / 2 + offset[1], text, color=colour, ha="center",
              va="center")


def save(figure):
    """Writes the file that the command names, without a date, so that equal figures have equal bytes."""
    if len(sys.argv) != 2:
        raise SystemExit(f"usage: {sys.argv[0]} FILE.svg")
    metadata = {"Date": None} if sys.argv[1].endswith(".svg") else None
    figure.savefig(sys.argv[1], bbox_inches="tight", metadata=metadata, dpi=150)
