"""Damping that jumps at touch, the weighted values at the ends of steps and their straight lines; weights over p."""
import numpy as np

from drawing import BLUE, GREEN, GREY, ORANGE, RED, graph, save


def weights(p):
    return 11 / 6 * p, 11 / 6 - 5 / 3 * p + p**2 / 2, 2 / 3 + 5 / 6 * p - p**2 / 2


figure, (left, right) = graph(7.2, 2.9, ncols=2)
p = 0.45
w = weights(p)
touch = 1 - p
left.fill_between([touch, 5], [1, 1], color=GREY, alpha=0.18, lw=0)
left.plot([-0.2, touch, touch, 5], [0, 0, 1, 1], color=GREY, lw=1.6, label="damping since touch")
left.plot([0, 1, 2, 3, 4, 5], [0, *w, 1, 1], "o-", color=BLUE, ms=4, label="weights, straight lines")
left.plot([0, 1, 2, 3, 4, 5], [0, 1, 1, 1, 1, 1], "s:", color=ORANGE, ms=3, lw=1, label="without weights")
for k, one in enumerate(w, 1):
    left.annotate(f"$w_{k}$", (k, one), textcoords="offset points", xytext=((8, -9), (4, 6), (2, -13))[k - 1],
                  color=BLUE)
left.annotate("", xy=(touch, -0.16), xytext=(1, -0.16), arrowprops={"arrowstyle": "<->", "lw": 0.9, "color": GREY},
              annotation_clip=False)
left.text(0.5 * (touch + 1), -0.33, "$p$", color=GREY, ha="center")
left.set(xlabel="time in steps", ylabel="weight of the damping", xlim=(-0.2, 5), ylim=(-0.45, 1.5), xticks=range(6))
left.legend(frameon=False, fontsize=8, loc="lower right", bbox_to_anchor=(1.0, 0.2))

x = np.linspace(0, 1, 100)
for k, (curve, colour) in enumerate(zip(weights(x), (BLUE, RED, GREEN)), 1):
    right.plot(x, curve, color=colour)
    at = (0.8, 0.2, 0.13)[k - 1]
    right.text(at - 0.02, np.interp(at, x, curve) + (0.07, 0.07, 0.13)[k - 1], f"$w_{k}(p)$", color=colour,
               ha="right" if k == 1 else "left")
for a, at in ((11 / 6, (1, 0)), (2 / 3, (1, 0)), (1, (1,)), (0, (0,))):
    right.plot(at, [a] * len(at), "o", color=GREY, ms=4)
    if len(at) == 2:
        right.plot(at, [a, a], ":", color=GREY, lw=0.9)
right.set(xlabel="closed part $p$ of the step of touch", ylabel="weight", xlim=(-0.03, 1.03), ylim=(-0.1, 2.0))
figure.tight_layout()
save(figure)
