"""Flow chart of the whole method: describe, compile, static state, steps in time."""
from matplotlib.patches import FancyBboxPatch, Polygon

from drawing import BLUE, GREY, INK, arrow, save, sketch

figure, axes = sketch(7.4, 7.4)
X, WIDE = 3.0, 5.6


def box(y, text, chapter="", height=0.72, colour="#e8eef5"):
    axes.add_patch(FancyBboxPatch((X - WIDE / 2, y - height / 2), WIDE, height,
                                  boxstyle="round,pad=0.03,rounding_size=0.1", fc=colour,
                                  ec=INK, lw=1))
    axes.text(X, y, text, ha="center", va="center", fontsize=8)
    if chapter:
        axes.text(X + WIDE / 2 + 0.22, y, chapter, color=BLUE, ha="left", va="center", fontsize=8, style="italic")


def question(y, text, height=0.95):
    axes.add_patch(Polygon([(X - WIDE / 2, y), (X, y + height / 2), (X + WIDE / 2, y), (X, y - height / 2)],
                           fc="#fdf3e1", ec=INK, lw=1))
    axes.text(X, y, text, ha="center", va="center", fontsize=8)


def down(y0, y1, text=""):
    arrow(axes, (X, y0), (X, y1))
    if text:
        axes.text(X + 0.1, 0.5 * (y0 + y1), text, fontsize=8, color=GREY, va="center")


box(11.6, "Describe: pipes, bodies, bit, joints,\nwall, drives, mud", "Kinematics; The element; Joints; Mud")
down(11.22, 10.94)
box(10.56, "Compile: nodes and frames, element matrices,\nconstraint rows, contact points",
    "Equations of motion; Contact")
down(10.18, 9.9)
box(9.52, "Static state: ladder of strategies, partition\nof coordinates, sign of the stiffness",
    "Statics and stability")
down(9.14, 8.76)
box(8.48, "Start: consistent accelerations", "Joints; Time integration", 0.5)
down(8.21, 7.88)
box(7.5, "Predict; prescribe drives; project poses,\nspeeds and accelerations onto constraints",
    "Time integration; Joints")
down(7.12, 6.84)
box(6.46, "Residual: elements, inertia, wall, friction,\nrock, drives; multipliers of dependent rows",
    "The element; Contact; Bit")
down(6.08, 5.9)
question(5.42, "residual small?")
down(4.94, 4.62, "yes")
box(4.24, "Contacts that opened, jumps:\nforces and accelerations made consistent", "Contact and friction")
down(3.86, 3.48)
box(3.2, "Accept: energy balance, rock surface, outputs", "Equations of motion; Bit", 0.5)
down(2.93, 2.75)
question(2.27, "end of the run?")
down(1.79, 1.47, "yes")
box(1.1, "Results: loads, stress, fatigue, modes,\nresponse, failure probability", "Drilling; Modes; Probability")

LEFT = X - WIDE / 2
axes.plot([LEFT, LEFT - 0.5, LEFT - 0.5], [5.42, 5.42, 6.46], color=INK, lw=1.3)
arrow(axes, (LEFT - 0.5, 6.46), (LEFT - 0.04, 6.46))
axes.text(LEFT - 0.6, 5.95, "no: Newton's\ncorrection", ha="right", va="center", fontsize=8, color=GREY)
axes.plot([LEFT, LEFT - 2.3, LEFT - 2.3], [2.27, 2.27, 7.5], color=INK, lw=1.3)
arrow(axes, (LEFT - 2.3, 7.5), (LEFT - 0.04, 7.5))
axes.text(LEFT - 2.2, 4.3, "no: next\nstep", ha="left", va="center", fontsize=8, color=GREY)
axes.set_xlim(-2.3, 9.6)
axes.set_ylim(0.6, 12.05)
save(figure)
