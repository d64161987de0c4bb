"""Samples of two normal numbers, the line where the margin vanishes and the closest failure; levels of a subset."""
import numpy as np

from drawing import BLUE, INK, ORANGE, RED, arrow, graph, save


def margin(x, y):
    return 3.2 - 0.75 * x - 0.6 * y - 0.09 * x * x


figure, (left, right) = graph(7.2, 3.3, ncols=2)
random = np.random.default_rng(7)
z = random.standard_normal((1800, 2))
g = margin(*z.T)
left.plot(*z[g > 0].T, ".", color=BLUE, ms=2.2, alpha=0.6)
left.plot(*z[g <= 0].T, ".", color=RED, ms=4)
x, y = np.meshgrid(np.linspace(-4, 4.6, 300), np.linspace(-4, 4.6, 300))
field = margin(x, y)
left.contour(x, y, field, levels=[0], colors=[INK], linewidths=1.5)
left.contourf(x, y, field, levels=[-50, 0], colors=["#f6dcd8"], zorder=0)
line = np.linspace(-4, 4.6, 20001)
edge = np.column_stack([line, (3.2 - 0.75 * line - 0.09 * line**2) / 0.6])
closest = edge[np.argmin(np.hypot(*edge.T))]
arrow(left, (0, 0), tuple(closest), "", INK)
left.text(*(0.62 * closest + (-0.3, 0.42)), r"$\beta$", color=INK, zorder=9,
          bbox={"fc": "white", "ec": "none", "pad": 1.0})
left.plot(*closest, "o", color=INK, ms=4)
left.text(2.3, 3.5, r"$g\leq 0$", color=RED)
left.text(-3.6, -3.6, "$g>0$", color=BLUE)
left.set_aspect("equal")
left.set(xlabel="$z_1$", ylabel="$z_2$", xlim=(-4, 4.6), ylim=(-4, 4.6))

many = margin(*random.standard_normal((2, 400000)))
right.hist(many, bins=160, density=True, color="#bcbcbc", zorder=1)
levels = np.quantile(many, [0.1, 0.01])
for k, level in enumerate((*levels, 0.0), 1):
    name = f"$b_{k}$" if level > 0.0 else "0"
    right.axvline(level, color=ORANGE if level > 0.0 else RED, lw=1.2)
    right.text(level + 0.07, 0.425, name, color=ORANGE if level > 0.0 else RED)
right.axvspan(-3, 0, color="#f6dcd8", lw=0, zorder=0)
right.set(xlabel="margin $g$", ylabel="density", xlim=(-1.2, 6.2), ylim=(0, 0.46))
figure.tight_layout()
save(figure)
