"""Frames of a pipe: nodes A and B in the world, rigid arms, the element and its relative coordinates."""
import numpy as np
from matplotlib.patches import Circle

from drawing import BLUE, GREEN, GREY, INK, LIGHT, ORANGE, RED, arrow, save, sketch


def triad(axes, place, angle, label, colour, size=0.5):
    """x along the pipe, y across it; z out of the page."""
    x, y = np.array([np.cos(angle), np.sin(angle)]), np.array([-np.sin(angle), np.cos(angle)])
    arrow(axes, place, place + size * x, "$x$" if label.endswith("B") else "", colour)
    arrow(axes, place, place + size * y, "$y$", colour)
    axes.add_patch(Circle(place, 0.05, fc="white", ec=colour, lw=1.2, zorder=7))
    axes.text(*(place - 0.5 * y - 0.05 * x), label, color=colour, ha="center", va="center")


def point(s):
    """Centre line of the element and its angle: an arc, s from 0 to 1."""
    turn, length = 0.7, 3.6
    angle = -0.25 + turn * s
    radius = length / turn
    return np.array([1.9 + radius * (np.sin(angle) - np.sin(-0.25)),
                     1.35 - radius * (np.cos(angle) - np.cos(-0.25))]), angle


figure, axes = sketch(7.2, 3.4)
grid = np.linspace(0.0, 1.0, 60)
line = np.array([point(s)[0] for s in grid])
normal = np.array([[-np.sin(point(s)[1]), np.cos(point(s)[1])] for s in grid])
for side in (-0.13, 0.13):
    axes.plot(*(line + side * normal).T, color=GREY, lw=1.0)
axes.plot(*line.T, color=LIGHT, lw=1.0, ls="-.")

(begin, first), (end, last) = point(0.0), point(1.0)
near = begin - 0.7 * np.array([np.cos(first), np.sin(first)])
far = end + 0.7 * np.array([np.cos(last), np.sin(last)])
for a, b, angle in ((near, begin, first), (end, far, last)):
    across = 0.2 * np.array([-np.sin(angle), np.cos(angle)])
    axes.fill(*np.array([a + across, b + across, b - across, a - across]).T, color=LIGHT, ec=GREY, lw=0.9, zorder=2)
    axes.text(*((a + b) / 2 + 1.75 * across), "arm", color=GREY, ha="center", va="center")

triad(axes, near, first, r"$H$ of node A", BLUE)
triad(axes, far, last, r"$H$ of node B", BLUE)
for place, angle, label in ((begin, first, r"$H_A$"), (end, last, r"$H_B$")):
    axes.plot(*place, "o", color=RED, ms=4, zorder=8)
    axes.text(*(place + 0.34 * np.array([-np.sin(angle), np.cos(angle)])), label, color=RED, ha="center", va="center")
axes.annotate("", xy=end + [-0.02, -0.3], xytext=begin + [0.02, -0.3], zorder=4,
              arrowprops={"arrowstyle": "-|>", "color": GREEN, "lw": 1.3, "connectionstyle": "arc3,rad=0.18"})
axes.text(4.35, 0.42, r"$d=\log(H_A^{-1}H_B)$", color=GREEN, ha="center")

middle, angle = point(0.55)
axes.plot(*np.array([middle - 0.13 * normal[33], middle + 0.13 * normal[33]]).T, color=ORANGE, lw=1.6)
axes.text(*(middle + 0.55 * normal[33]), r"$H(x)=H_A\exp(xd)\exp(c(x)d)$", color=ORANGE, ha="center")

origin = np.array([0.1, -0.1])
arrow(axes, origin, origin + [0.6, 0.0], "$x$ north", INK, at=(1.15, -0.1))
arrow(axes, origin, origin + [0.0, 0.6], "$z$ up", INK)
axes.text(0.02, -0.3, "world", color=INK, ha="center")
arrow(axes, origin, near - [0.05, 0.05], "", GREY, lw=0.8)
arrow(axes, origin, far - [0.1, 0.1], "", GREY, lw=0.8)
axes.text(0.38, 0.85, r"$x_A$", color=GREY)
axes.text(2.4, 0.45, r"$x_B$", color=GREY)
axes.set_xlim(-0.4, 7.3)
axes.set_ylim(-0.5, 3.0)
save(figure)
