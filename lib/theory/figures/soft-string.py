"""Balance of an element of the soft string in a bend."""
import numpy as np

from drawing import BLUE, GREEN, GREY, INK, LIGHT, RED, arrow, save, sketch

figure, axes = sketch(6.6, 3.3)
K = 1 / 3.2
angle = np.linspace(-0.95, 0.95, 200)
centre = np.array([0.0, 3.2])


def at(a, radius=3.2):
    return centre + radius * np.array([np.sin(a), -np.cos(a)])


for radius in (3.2 - 0.32, 3.2 + 0.32):
    axes.plot(*np.array([at(a, radius) for a in angle]).T, color=LIGHT, lw=2.2)
axes.plot(*np.array([at(a) for a in angle]).T, color=GREY, lw=0.8, ls=(0, (7, 3)))
inside = np.linspace(-0.42, 0.42, 80)
axes.plot(*np.array([at(a) for a in inside]).T, color=INK, lw=7, solid_capstyle="butt", alpha=0.75)


def tangent(a):
    return np.array([np.cos(a), np.sin(a)])


a, b = -0.42, 0.42
arrow(axes, at(a), at(a) - 1.35 * tangent(a), r"$-N\,\mathbf{t}$", BLUE, at=at(a) - 1.2 * tangent(a) + (0.1, 0.36))
arrow(axes, at(b), at(b) + 1.45 * tangent(b), r"$(N+dN)(\mathbf{t}+\mathbf{k}\,ds)$", BLUE,
      at=at(b) + 1.5 * tangent(b) + (0.85, 0.2))
arrow(axes, at(0), at(0) + (0, -1.15), r"$\mathbf{w}\,ds$", INK, at=at(0) + (0.3, -1.1))
arrow(axes, at(0.12, 3.2 - 0.32) + (-0.1, 1.15), at(0.12, 3.2 - 0.32), "$c\\,ds$", RED,
      at=at(0.12, 3.2 - 0.32) + (-0.42, 0.95))
arrow(axes, at(-0.1, 3.2 - 0.32), at(-0.1, 3.2 - 0.32) - 0.95 * tangent(-0.1), r"$\mu c\,\frac{v_a}{|\mathbf{v}|}\,ds$",
      GREEN,
      at=at(-0.1, 3.2 - 0.32) - 0.75 * tangent(-0.1) + (0, 0.42))
axes.annotate("", xy=at(0.78, 3.2 + 0.75), xytext=at(0.52, 3.2 + 0.75),
              arrowprops={"arrowstyle": "-|>", "color": GREY, "lw": 1})
axes.text(*at(0.65, 3.2 + 1.0), r"motion $v_a$", color=GREY, ha="left", va="center")
axes.text(*at(-0.82, 3.2 + 0.6), "to the rig", color=GREY, ha="center", va="center")
axes.text(-0.02, 1.72, "wall pushes back where the\ntensions press the string", color=RED, ha="left", va="bottom",
          fontsize=8)
axes.set_xlim(-3.5, 4.3)
axes.set_ylim(-1.45, 2.4)
save(figure)
