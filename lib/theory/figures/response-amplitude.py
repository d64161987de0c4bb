"""Amplitude of one mode by a constant force and by an eccentric mass; Campbell diagram of a rotor."""
import numpy as np

from drawing import BLUE, GREEN, GREY, LIGHT, RED, graph, save

figure, (left, right) = graph(7.4, 3.1, ncols=2)
x = np.geomspace(0.08, 6, 900)
zeta, crossing = 0.03, 0.35  # damping ratio; frequency at which both forces are equal
dynamic = 1 / np.abs(1 - x**2 + 2j * zeta * x)
left.loglog(x, dynamic, color=BLUE, label="friction: constant force")
left.loglog(x, dynamic * (x / crossing) ** 2, color=RED, label=r"eccentricity: force $\propto\Omega^2$")
left.axvline(crossing, color=GREY, lw=0.9, ls=":")
left.axvline(1, color=LIGHT, lw=0.9)
left.text(crossing * 0.95, 0.016, "forces equal", color=GREY, rotation=90, ha="right", va="bottom", fontsize=8)
left.set(xlabel="frequency over natural frequency", ylabel="amplitude over static one", ylim=(0.012, 9000),
         xlim=(0.08, 6))
left.legend(frameon=False, fontsize=8, loc="upper left")

speed = np.linspace(0, 3, 200)
flat = ((1.0, "bending", BLUE), (2.15, "torsion", GREEN))
for w, name, colour in flat[1:]:
    right.plot(speed, w + 0 * speed, color=colour)
    right.text(0.05, w + 0.06, name, color=colour, fontsize=8)
g = 0.22
forward, backward = np.sqrt(1 + (g * speed) ** 2) + g * speed, np.sqrt(1 + (g * speed) ** 2) - g * speed
right.plot(speed, forward, color=BLUE)
right.plot(speed, backward, color=BLUE, ls="--")
right.text(2.05, 1.76, "forward", color=BLUE, fontsize=8)
right.text(2.1, 0.74, "backward", color=BLUE, fontsize=8)
for order, style in ((1, "-"), (2, "-.")):
    right.plot(speed, order * speed, color=GREY, lw=1, ls=style)
    right.text(min(3, 3 / order) * 0.93, 2.95, rf"$k={order}$", color=GREY, ha="right", va="top", fontsize=8)
    for curve in (forward, backward, 2.15 + 0 * speed):
        k = np.argmin(np.abs(order * speed - curve))
        if curve[k] < 2.95:
            right.plot(speed[k], curve[k], "o", color=RED, ms=4, zorder=5)
right.set(xlabel=r"rotary speed $\Omega$", ylabel=r"frequency $\omega$", xlim=(0, 3), ylim=(0, 3), xticks=range(4),
          yticks=range(4))
figure.tight_layout()
save(figure)
