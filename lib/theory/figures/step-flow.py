"""One step of fixed length as a flow chart."""
from matplotlib.patches import FancyBboxPatch, Polygon

from drawing import BLUE, GREEN, GREY, INK, RED, arrow, save, sketch

figure, axes = sketch(8.4, 8.0)
WIDE, HIGH = 5.2, 0.68


def box(x, y, text, colour=BLUE, wide=WIDE, high=HIGH):
    axes.add_patch(FancyBboxPatch((x - wide / 2, y - high / 2), wide, high, boxstyle="round,pad=0.03", fc="#f6f9fc",
                                  ec=colour, lw=1.1))
    axes.text(x, y, text, ha="center", va="center", fontsize=8)


def question(x, y, text, wide=4.3, high=1.0):
    corners = ((x - wide / 2, y), (x, y + high / 2), (x + wide / 2, y), (x, y - high / 2))
    axes.add_patch(Polygon(corners, closed=True, fc="#fdf6f0", ec=RED, lw=1.1))
    axes.text(x, y, text, ha="center", va="center", fontsize=8)


def way(*points, label="", at=None):
    for a, b in zip(points[:-2], points[1:-1]):
        axes.plot((a[0], b[0]), (a[1], b[1]), color=INK, lw=1.2)
    arrow(axes, points[-2], points[-1])
    if label:
        axes.text(*at, label, fontsize=8, color=GREY, ha="center", va="center")


box(0, 10.4, "length $h$: to the end asked for,\nthe next breakpoint or half a failed step")
box(0, 9.3, "predict $z$, $v_1$, $\\dot v_1$, $a_1$: constant or linear\nprescribed components")
box(0, 8.2, "project onto the joints:\npose, velocity, acceleration")
box(0, 7.1, "forces and residual $r$; tangent if needed\nmultipliers balance dependent rows")
question(0, 5.85, "stopping rule met?")
box(0, 4.55, "factors: reused, or new from\n$S=\\beta'M+\\gamma'C_t+K_t\\mathbf{T}(z)$", GREEN)
box(0, 3.5, "$S\\,\\delta z=-r$;  $z$, $v_1$, $\\dot v_1$, $a_1$, $H_1=H_0\\exp z$", GREEN)
question(6.2, 5.85, "contacts open?")
question(6.2, 4.3, "errors: joints singular,\nelement turned too far?", high=1.2)
box(6.2, 2.75, "accept: unwrapped angles, drives, bit,\ncontacts, ledger; swap trial and accepted state")
box(6.2, 1.75, "jumps at the end of the step:\naccelerations made consistent anew")
box(0, 1.75, "failed: once more with a constant prediction\nand new factors, then half the step", RED)
for high, low in ((10.03, 9.67), (8.93, 8.57), (7.83, 7.47), (6.73, 6.38), (4.18, 3.87)):
    way((0, high), (0, low))
way((0, 5.35), (0, 4.92), label="no", at=(0.25, 5.14))
way((-2.63, 3.5), (-3.2, 3.5), (-3.2, 8.2), (-2.66, 8.2), label="next\niteration", at=(-3.75, 6.0))
way((2.15, 5.85), (4.02, 5.85), label="yes", at=(3.05, 6.02))
way((6.2, 6.35), (6.2, 8.2), (2.66, 8.2), label="yes: history less their force", at=(4.4, 8.38))
way((6.2, 5.35), (6.2, 4.93), label="no", at=(6.45, 5.14))
way((6.2, 3.7), (6.2, 3.12), label="no", at=(6.45, 3.45))
way((6.2, 2.38), (6.2, 2.12))
way((4.05, 4.3), (3.1, 4.3), (3.1, 1.75), (2.66, 1.75), label="yes", at=(3.5, 4.47))
way((0, 3.13), (0, 2.12), label="diverges, or\nmax_iterations", at=(-0.95, 2.62))
way((-2.63, 1.75), (-4.4, 1.75), (-4.4, 10.4), (-2.66, 10.4))
axes.set_xlim(-4.6, 9.0)
axes.set_ylim(1.2, 10.9)
save(figure)
