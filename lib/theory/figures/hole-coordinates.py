"""A hole through stations of a survey, its frame at a depth, and a point with two feet on the axis."""
import numpy as np

from drawing import BLUE, GREY, INK, LIGHT, ORANGE, RED, arrow, save, sketch

figure, axes = sketch(6.6, 3.5)

# Straight down, an arc of a right angle and more, straight on: x to the right, z up.
K = 1 / 2.0
S = np.linspace(-1.2, 8.6, 800)


def place(s):
    turn = np.clip(s - 1.0, 0, 5.2) * K  # angle from the start direction
    start, point = np.array([0.25, -0.97]), None
    start = start / np.linalg.norm(start)
    side = np.array([0.97, 0.25]) / np.linalg.norm([0.97, 0.25])
    first = min(s, 1.0)
    arc = np.clip(s - 1.0, 0, 5.2)
    point = first * start + (np.sin(arc * K) / K) * start + ((1 - np.cos(arc * K)) / K) * side
    tangent = np.cos(turn) * start + np.sin(turn) * side
    return point + max(s - 6.2, 0) * tangent, tangent


points = np.array([place(s)[0] for s in S])
tangents = np.array([place(s)[1] for s in S])
normals = np.column_stack([-tangents[:, 1], tangents[:, 0]])
for side in (-0.16, 0.16):
    axes.plot(*(points + side * normals).T, color=LIGHT, lw=2.2)
axes.plot(*points.T, color=GREY, lw=0.9, ls=(0, (7, 3)))
for s, text, off in ((-1.2, "$s_0$", (-0.3, 0.02)), (1.0, "$s_1$", (-0.33, 0)), (6.2, "$s_2$", (0.33, -0.05))):
    at = place(s)[0]
    axes.plot(*at, "o", color=INK, ms=4)
    axes.text(at[0] + off[0], at[1] + off[1], text, ha="center", va="center")

# Frame and a contact point near s = 1.9
foot, t = place(1.9)
n = np.array([t[1], -t[0]])
x = foot + 0.62 * n
arrow(axes, foot, foot + 0.85 * t, r"$\mathbf{t}$", BLUE)
arrow(axes, foot, foot + 0.85 * n, r"$\mathbf{n}$", BLUE)
axes.plot(*foot, "o", color=BLUE, ms=4)
axes.text(foot[0] + 0.28, foot[1] + 0.2, r"$\mathbf{p}(s)$", color=BLUE, ha="center")
axes.plot(*x, "o", color=RED, ms=5, zorder=7)
axes.text(x[0] - 0.02, x[1] - 0.24, r"$\mathbf{x}$", color=RED, ha="center")

# The centre of the arc has all of it as near: a point beside it has a foot on both legs.
y = np.array([1.95, 0.0])
axes.plot(*y, "o", color=ORANGE, ms=5)
axes.text(y[0] + 0.1, y[1] + 0.5, "point with\nseveral roots", color=ORANGE, ha="center")
distance = np.linalg.norm(points - y, axis=1)
feet = [k for k in range(1, len(S) - 1) if distance[k] < distance[k - 1] and distance[k] < distance[k + 1]]
for k in feet:
    axes.plot([y[0], points[k, 0]], [y[1], points[k, 1]], color=ORANGE, lw=1, ls=":")
    axes.plot(*points[k], "o", color=ORANGE, ms=4)

# World axes and angles of the first station
o = np.array([-2.2, -1.9])
arrow(axes, o, o + (0.8, 0), "north $x$", at=o + (1.25, 0))
arrow(axes, o, o + (0, 0.8), "up $z$", at=o + (0, 0.97))
axes.plot(*o, "o", ms=7, mfc="none", color=INK)
axes.plot(*o, ".", ms=3, color=INK)
axes.text(o[0] - 0.12, o[1] - 0.24, "west $y$", ha="center")
axes.set_xlim(-2.7, 5.2)
axes.set_ylim(-2.8, 1.35)
save(figure)
