"""Sinusoidal and helical shapes of a string in its hole: angle on the wall along the string, and in the section."""
import numpy as np
from matplotlib.patches import Circle

from drawing import BLUE, GREY, INK, LIGHT, RED, save
import matplotlib.pyplot as plt

figure, rows = plt.subplots(2, 2, figsize=(7.0, 3.6), gridspec_kw={"width_ratios": (4.2, 1)})
s = np.linspace(0, 3, 900)
shapes = (("sinusoidal buckling", np.radians(38) * np.sin(2 * np.pi * s), BLUE),
          ("helical buckling", 2 * np.pi * s, RED))
for (along, across), (title, angle, colour) in zip(rows, shapes):
    y = np.sin(angle)  # sideways, angle from the bottom
    behind = np.cos(angle) < 0
    along.axhline(1, color=GREY, lw=1.2)
    along.axhline(-1, color=GREY, lw=1.2)
    along.axhline(0, color=LIGHT, lw=0.8)
    for mask, style in ((behind, ":"), (~behind, "-")):
        along.plot(s, np.where(mask, y, np.nan), style, color=colour)
    along.set(xlim=(0, 3), ylim=(-1.25, 1.25), yticks=(-1, 0, 1), yticklabels=("$-r$", "0", "$r$"), xticks=range(4))
    along.set_title(title + ", seen from above", fontsize=9, loc="left")
    across.set_aspect("equal")
    across.axis("off")
    across.add_patch(Circle((0, 0), 1, fc="none", ec=GREY, lw=1.2))
    across.plot(np.sin(angle), -np.cos(angle), color=colour, lw=2)
    across.annotate("", xy=(0, -0.55), xytext=(0, 0.1), arrowprops={"arrowstyle": "-|>", "color": INK, "lw": 0.9})
    across.text(0.12, -0.18, "$w$", fontsize=9)
    across.set(xlim=(-1.2, 1.2), ylim=(-1.2, 1.2))
rows[1][0].set_xlabel("way along the hole in wavelengths")
rows[0][0].set_ylabel("sideways")
rows[1][0].set_ylabel("sideways")
figure.tight_layout()
save(figure)
