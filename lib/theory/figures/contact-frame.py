"""Section of the hole with an eccentric pipe: frame, depth in the wall, forces on the pipe and its rotation."""
import numpy as np
from matplotlib.patches import Arc, Circle

from drawing import BLUE, GREEN, GREY, INK, RED, arrow, save, sketch

figure, axes = sketch(6.8, 4.4)
R, r, e, angle = 2.6, 1.75, 1.05, np.radians(-60)
n = np.array([np.cos(angle), np.sin(angle)])
b = np.array([-n[1], n[0]])
x = e * n


def towards(degrees):
    return np.array([np.cos(np.radians(degrees)), np.sin(np.radians(degrees))])


axes.add_patch(Circle((0, 0), R + 0.6, fc="#efe9df", ec="none"))
axes.add_patch(Circle((0, 0), R, fc="white", ec=GREY, lw=1.6))
axes.add_patch(Circle(x, r, fc="#dfe8f1", ec=INK, lw=1.4))
axes.plot(0, 0, "+", color=GREY, ms=11, mew=1.4)
axes.annotate(r"axis, $\mathbf{p}(s)$", xy=(0, 0.06), xytext=(0.3, 1.8), color=GREY, ha="center",
              arrowprops={"arrowstyle": "-", "color": GREY, "lw": 0.8})
axes.plot([0, x[0]], [0, x[1]], color=GREY, lw=1.2)
axes.text(*(0.5 * x + 0.2 * b), "$e$", color=GREY, ha="center", va="center")
arrow(axes, (0, 0), R * towards(155), "$R$", GREY, at=0.6 * R * towards(155) + (0.1, 0.22))

axes.plot(*x, "o", color=INK, ms=4)
axes.text(*(x + (-0.26, 0.02)), r"$\mathbf{x}$", ha="center", va="center")
arrow(axes, x, x + 1.0 * n, r"$\mathbf{n}$", BLUE, at=x + 0.95 * n - 0.25 * b)
arrow(axes, x, x + 1.0 * b, r"$\mathbf{b}$", BLUE, at=x + 1.2 * b)
at = x - 0.75 * b - 0.1 * n
axes.plot(*at, "o", ms=10, mfc="none", color=BLUE)
axes.plot(*at, ".", ms=4, color=BLUE)
axes.text(*(at - (0.3, 0.0)), r"$\mathbf{t}$", color=BLUE, ha="center", va="center")
arrow(axes, x, x + r * towards(62), "$r$", INK, at=x + 0.62 * r * towards(62) + (-0.17, 0.1))

place = x + r * n
arrow(axes, place + 1.25 * n, place + 0.04 * n, r"$-N\,\mathbf{n}$", RED, at=place + 1.5 * n)
arrow(axes, place, place - 1.5 * b, r"$F_b\,\mathbf{b}$", GREEN, at=place - 1.85 * b)
axes.add_patch(Arc(x, 2.5, 2.5, theta1=100, theta2=190, color=INK, lw=1.2))
tip = x + 1.25 * towards(190)
arrow(axes, tip + (-0.012, 0.12), tip + (0.02, -0.05))
axes.text(*(x + 1.25 * towards(145) + (-0.24, 0.16)), r"$\omega_x$", ha="center", va="center")
axes.annotate(r"depth in the wall $\delta=e-(R-r)$", xy=0.5 * (R * n + place), xytext=(2.6, -3.25), color=RED,
              ha="left", va="center", arrowprops={"arrowstyle": "-", "color": RED, "lw": 0.9})
axes.set_xlim(-3.4, 5.6)
axes.set_ylim(-4.2, 3.3)
save(figure)
