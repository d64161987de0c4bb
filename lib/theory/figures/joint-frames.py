"""Frames of a joint: markers on two bodies, the vector between them, and the axes of the scalar products."""
import numpy as np
from matplotlib.patches import Ellipse

from drawing import BLUE, GREEN, GREY, INK, RED, arrow, save, sketch


def frame(axes, place, angle, name, colour, size=0.75):
    for k, letter in ((0.0, "x"), (np.pi / 2, "y")):
        direction = np.array([np.cos(angle + k), np.sin(angle + k)])
        arrow(axes, place, place + size * direction, f"${letter}_{name}$" if name else "", colour)


figure, axes = sketch(6.8, 3.3)
bodies = ((np.array([1.4, 1.5]), 2.5, 1.7, 10.0), (np.array([5.4, 1.8]), 2.6, 1.5, -15.0))
for centre, width, height, angle in bodies:
    axes.add_patch(Ellipse(centre, width, height, angle=angle, fc="#f4f4f4", ec=GREY, lw=1.0))
node_a, node_b = np.array([0.75, 1.35]), np.array([6.1, 1.55])
marker_a, marker_b = np.array([2.3, 1.3]), np.array([4.5, 1.9])
frame(axes, node_a, 0.15, "", GREY, 0.45)
frame(axes, node_b, 0.5, "", GREY, 0.45)
axes.text(0.45, 1.02, r"node of body a, $v_a$", color=GREY, ha="left")
axes.text(5.35, 1.3, r"node of body b, $v_b$", color=GREY, ha="left")
frame(axes, marker_a, 0.35, "a", BLUE)
frame(axes, marker_b, 0.9, "b", RED)
arrow(axes, node_a, marker_a, "", GREY, lw=0.8)
arrow(axes, node_b, marker_b, "", GREY, lw=0.8)
arrow(axes, marker_a, marker_b, "", GREEN)
axes.text(3.55, 1.42, r"$R_a\rho$", color=GREEN, ha="center")
axes.text(2.42, 1.08, r"$H_a$", color=BLUE, ha="center")
axes.text(4.75, 1.62, r"$H_b$", color=RED, ha="center")
axes.text(3.45, 0.28, r"$H_{ab}=H_a^{-1}H_b=(R,\rho)$   equations: $\rho_i$ and $R_{ij}=e_i\cdot Re_j$", color=INK,
          ha="center")
axes.set_xlim(-0.1, 7.4)
axes.set_ylim(0.05, 3.2)
save(figure)
