"""Left: a bit on the bottom of its hole with its forces. Right: rock surface under the blades over the angle."""
import numpy as np
import matplotlib.pyplot as plt
from matplotlib.patches import Polygon, Rectangle

from drawing import BLUE, GREEN, GREY, INK, ORANGE, RED, arrow, dimension, save

figure, (left, right) = plt.subplots(1, 2, figsize=(7.2, 3.3), gridspec_kw={"width_ratios": (1, 1.35)})
left.set_aspect("equal")
left.axis("off")
rock = "#efe9df"
left.add_patch(Polygon([(-1.5, 2.4), (-1.05, 2.4), (-1.05, 0), (1.05, 0), (1.05, 2.4), (1.5, 2.4), (1.5, -1.3),
                        (-1.5, -1.3)],
                       fc=rock, ec="none"))
left.plot([-1.05, -1.05, 1.05, 1.05], [2.4, 0, 0, 2.4], color=GREY, lw=1.5)
left.add_patch(Rectangle((-0.35, 1.1), 0.7, 1.3, fc="#dfe8f1", ec=INK))
left.add_patch(Polygon([(-0.5, 1.1), (0.5, 1.1), (1.0, 0.45), (1.0, 0.0), (-1.0, 0.0), (-1.0, 0.45)], fc="#c9d6e4",
                       ec=INK))
left.plot([0, 0], [2.65, -0.2], color=GREY, lw=0.8, ls=(0, (7, 3)))
arrow(left, (0, -1.15), (0, -0.05), "", RED)
left.text(0.18, -0.72, "$W$", color=RED, va="center")


def turn(middle, width, height, begin, end, colour):
    """An arc of an ellipse with an arrow at its end [degrees]."""
    w = np.radians(np.linspace(begin, end, 60))
    x, y = middle[0] + width * np.cos(w), middle[1] + height * np.sin(w)
    left.plot(x, y, color=colour, lw=1.3)
    arrow(left, (x[-4], y[-4]), (x[-1], y[-1]), "", colour)


turn((0, 1.85), 0.62, 0.2, 190, 372, BLUE)
left.text(0.76, 1.78, r"$\Omega$", color=BLUE)
turn((0, -0.12), 0.85, 0.25, 355, 188, RED)
left.text(-0.8, -0.55, "$T$", color=RED)
arrow(left, (-0.72, 2.4), (-0.72, 1.65), "$V$", BLUE, at=(-0.72, 1.45))
arrow(left, (1.75, 0.25), (1.05, 0.25), r"$\mathbf{F}$", GREEN, at=(1.95, 0.25))
dimension(left, (0, 2.62), (1.05, 2.62), "$a$", offset=(0, 0.16))
left.set(xlim=(-1.7, 2.2), ylim=(-1.4, 2.95))

# Surface over angle: blades at phi and phi - 2 pi/n move to the right and down.
phi = np.linspace(-2.6, 2.4, 500)


def advance(x):
    return 0.42 * x + 0.1 * np.sin(2.6 * x)


spacing = 2.0
old = advance(phi - spacing)
new = np.where(phi <= 0.6, advance(phi), np.nan)
right.fill_between(phi, -np.where(phi <= 0.6, advance(phi), old), -2.2, color=rock, lw=0)
right.plot(phi, -old, color=ORANGE, ls="--", label="left by the blade before")
right.plot(phi, -new, color=BLUE, label="cut by this blade")
x = 0.6
top, bottom = -advance(x - spacing), -advance(x)
right.add_patch(Polygon([(x, bottom), (x + 0.5, bottom + 0.75), (x + 0.28, bottom + 0.95), (x, top + 0.0)],
                        fc="#c9d6e4", ec=INK))
dimension(right, (x - 0.12, bottom), (x - 0.12, top), "$d_n$", colour=INK, offset=(-0.24, 0))
right.annotate("", xy=(x, 1.15), xytext=(x - spacing, 1.15), arrowprops={"arrowstyle": "<->", "color": GREY, "lw": 0.9})
right.text(x - 0.5 * spacing, 1.28, r"$2\pi/n$", color=GREY, ha="center")
right.plot([x - spacing, x - spacing], [-advance(x - spacing), 1.2], color=GREY, lw=0.7, ls=":")
right.plot([x, x], [top, 1.2], color=GREY, lw=0.7, ls=":")
right.text(1.55, -1.35, "rock", color=GREY)
arrow(right, (1.2, 0.95), (1.9, 0.95), "", BLUE)
right.text(1.55, 1.08, r"$\Omega$", color=BLUE, ha="center")
right.set(xlabel=r"angle $\Phi$", ylabel="height of the surface", xlim=(-2.6, 2.4), ylim=(-2.0, 1.9), xticks=[],
          yticks=[])
right.legend(frameon=False, fontsize=8, loc="lower left")
figure.tight_layout()
save(figure)
