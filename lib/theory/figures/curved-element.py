"""A curved element: frame of the middle, centre of mass, sections."""
import numpy as np

from drawing import BLUE, GREEN, GREY, INK, LIGHT, ORANGE, RED, arrow, save, sketch

figure, axes = sketch(6.6, 2.9)
bend, length = 1.3, 6.0
radius = length / bend


def at(s):
    """Centre line at s from -1/2 to 1/2 in the axes of the middle; its angle."""
    angle = bend * s
    return np.array([radius * np.sin(angle), -radius * (1.0 - np.cos(angle))]), -angle


grid = np.linspace(-0.5, 0.5, 80)
line = np.array([at(s)[0] for s in grid])
normal = np.array([[np.sin(-at(s)[1]), np.cos(at(s)[1])] for s in grid])
for side in (-0.16, 0.16):
    axes.plot(*(line + side * normal).T, color=GREY, lw=1.0)
axes.plot(*line.T, color=LIGHT, lw=1.0, ls="-.")
ends = line[0], line[-1]
axes.plot(*np.array(ends).T, color=GREY, lw=0.9, ls="--")
chord = (ends[0] + ends[1]) / 2
centre = np.array([0.0, np.mean(line[:, 1])])

for place, angle, name in ((ends[0], bend / 2, "A"), (ends[1], -bend / 2, "B")):
    x, y = np.array([np.cos(angle), np.sin(angle)]), np.array([-np.sin(angle), np.cos(angle)])
    arrow(axes, place, place + 0.8 * x, "$x$", BLUE)
    arrow(axes, place, place + 0.8 * y, "$y$", BLUE)
    axes.text(*(place - 0.35 * y - (0.25 if name == "A" else -0.1) * x), f"$H_{name}$", color=BLUE, ha="center")
arrow(axes, (0.0, 0.0), (0.8, 0.0), "$x$", RED)
arrow(axes, (0.0, 0.0), (0.0, 0.8), "$y$", RED)
axes.text(-0.55, 0.45, r"middle: $R_m=R_A\exp(\tilde\Theta/2)$", color=RED, ha="right")
axes.plot(*chord, "o", color=GREY, ms=4)
axes.text(chord[0] + 0.12, chord[1] - 0.24, r"$\frac{1}{2}(x_A+x_B)$", color=GREY, ha="left")
axes.plot(*centre, "o", color=GREEN, ms=5, zorder=7)
arrow(axes, chord, centre, "", GREEN)
axes.text(centre[0] - 0.15, (chord[1] + centre[1]) / 2, r"$R_mz$", color=GREEN, ha="right", va="center")
axes.text(centre[0] + 0.15, centre[1] - 0.05, r"$x_c$", color=GREEN, ha="left", va="center")
place, _ = at(0.32)
arrow(axes, (0.0, 0.0), place, "", ORANGE, lw=0.9)
axes.text(0.75, -0.42, r"$y(x)$", color=ORANGE)
arrow(axes, at(0.36)[0] + [0.35, 0.55], at(0.36)[0] + [0.62, 0.33], "", INK, connectionstyle="arc3,rad=-0.9")
axes.text(2.75, 0.35, r"spin $W$ about the bent axis: $\dot d=-We_x\times d$", color=INK, ha="left")
axes.set_xlim(-4.0, 7.4)
axes.set_ylim(-2.2, 1.4)
save(figure)
