"""Speed and shear stress over the radius of a concentric annulus, for two exponents of the power law."""
import numpy as np

from drawing import BLUE, GREY, INK, ORANGE, graph, save

RATIO = 0.5


def trapezoid(y, x):
    return np.concatenate([[0], np.cumsum(0.5 * (y[1:] + y[:-1]) * np.diff(x))])


def halves(square, n):
    """Speed built up from both walls to the radius without shear."""
    edge = np.sqrt(square)
    inner, outer = np.linspace(RATIO, edge, 2000), np.linspace(edge, 1, 2000)
    from_pipe = trapezoid(np.abs(square / inner - inner) ** (1 / n), inner)
    from_wall = trapezoid((np.abs(outer - square / outer) ** (1 / n))[::-1], (1 - outer)[::-1])[::-1]
    return inner, from_pipe, outer, from_wall


def profile(n):
    low, high = RATIO**2, 1.0
    for _ in range(60):
        square = 0.5 * (low + high)
        _, a, _, b = halves(square, n)
        low, high = (square, high) if a[-1] < b[0] else (low, square)
    inner, a, outer, b = halves(square, n)
    x, speed = np.concatenate([inner, outer]), np.concatenate([a, b])
    flow = np.sum(0.5 * (speed[1:] * x[1:] + speed[:-1] * x[:-1]) * np.diff(x)) * 2 / (1 - RATIO**2)
    return np.sqrt(square), x, speed / flow, (square / x - x)


figure, (left, right) = graph(7.0, 2.9, ncols=2, sharey=True)
for n, colour in ((1.0, BLUE), (0.4, ORANGE)):
    edge, x, speed, stress = profile(n)
    left.plot(speed, x, color=colour, label=f"$n={n:g}$")
    right.plot(stress / abs(stress[-1]), x, color=colour)
    for axes in (left, right):
        axes.axhline(edge, color=colour, lw=0.8, ls=":")
left.axhspan(0.4, RATIO, color="#c9d6e4", lw=0)
right.axhspan(0.4, RATIO, color="#c9d6e4", lw=0)
left.axhspan(1.0, 1.08, color="#efe9df", lw=0)
right.axhspan(1.0, 1.08, color="#efe9df", lw=0)
left.text(0.05, 0.445, "pipe", va="center", color=INK, fontsize=8)
left.text(0.05, 1.038, "wall of the hole", va="center", color=GREY, fontsize=8)
left.text(0.08, edge + 0.05, r"$\lambda R$", color=GREY)
right.axvline(0, color=GREY, lw=0.8)
left.set(xlabel="speed over mean speed", ylabel="radius over $R$", ylim=(0.4, 1.08), xlim=(0, 1.7))
right.set(xlabel="shear stress over that at the wall", xlim=(-1.1, 1.7))
left.legend(frameon=False, fontsize=8, loc="center left", bbox_to_anchor=(0.0, 0.42))
figure.tight_layout()
save(figure)
