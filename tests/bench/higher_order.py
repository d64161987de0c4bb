#!/usr/bin/python3
"""How much could a method of higher order save where nothing touches?

usage: tests/bench/higher_order.py      (numpy, scipy; 20 s; prints the table of *A higher order* in NOTEBOOK.md)

Scenes C and T as linear finite elements, whose modes are integrated by each method: their exact course is a closed
form, so the error is that of the method alone. A step of a method with s implicit stages evaluates the forces s times
at least, each as dear as in a step of generalized-alpha with one iteration; solutions of its larger systems come on
top.
The ratio of the steps that reach the same error, divided by s, is therefore more than the method can save.

Methods: generalized-alpha (Chung, Hulbert 1993) with radius 0.8, the library's; the same extrapolated from two courses;
Radau IIA of 2 and 3 stages, Gauss of 2, SDIRK of 5 (Hairer, Wanner: Solving Ordinary Differential Equations II, IV.5
and IV.6).
"""
import numpy as np
from scipy.linalg import eigh

GOAL = 1e-6
INSTANTS = 0.08 * np.arange(1, 11)  # seconds, those of scene W
YOUNG, SHEAR, DENSITY = 206e9, 206e9 / 2.6, 7850.0
OUTER, INNER = 0.073, 0.059
SIX, THREE = np.sqrt(6.0), np.sqrt(3.0)
RUNGE_KUTTA = {
    "Radau IIA, order 3": [[5 / 12, -1 / 12], [3 / 4, 1 / 4]],
    "Gauss, order 4": [[1 / 4, 1 / 4 - THREE / 6], [1 / 4 + THREE / 6, 1 / 4]],
    "SDIRK, order 4": [[1 / 4, 0, 0, 0, 0], [1 / 2, 1 / 4, 0, 0, 0], [17 / 50, -1 / 25, 1 / 4, 0, 0],
                       [371 / 1360, -137 / 2720, 15 / 544, 1 / 4, 0], [25 / 24, -49 / 48, 125 / 16, -85 / 12, 1 / 4]],
    "Radau IIA, order 5": [[(88 - 7 * SIX) / 360, (296 - 169 * SIX) / 1800, (-2 + 3 * SIX) / 225],
                           [(296 + 169 * SIX) / 1800, (88 + 7 * SIX) / 360, (-2 - 3 * SIX) / 225],
                           [(16 - SIX) / 36, (16 + SIX) / 36, 1 / 9]],
}


def assembled(elements, size, mass, stiffness, weight):
    """Matrices and vector of a chain of equal elements that share `size` coordinates with the next."""
    total = size * (elements + 1)
    sums = np.zeros((total, total)), np.zeros((total, total)), np.zeros(total)
    for first in range(0, size * elements, size):
        at = slice(first, first + 2 * size)
        sums[0][at, at] += mass
        sums[1][at, at] += stiffness
        sums[2][at] += weight
    return sums


class Tube:
    """Scene C: 100 m in torsion, relative to the turned end, whose speed is a polynomial of the time."""

    def __init__(self, speed):
        length = 1.0
        mass, stiffness, _ = assembled(100, 1, DENSITY * length / 6 * np.array([[2, 1], [1, 2]]),
                                       SHEAR / length * np.array([[1, -1], [-1, 1]]), 0.0)
        self.squares, shapes = eigh(stiffness[1:, 1:], mass[1:, 1:])
        self.pull, self.weight = -shapes.T @ mass[1:].sum(axis=1), np.zeros_like(self.squares)
        self.tip, self.angle, self.acceleration = shapes[-1], speed.integ(), speed.deriv()
        self.output, self.exact = 1, self.course()  # the speed of the tip
        self.scale = np.sqrt(np.mean((self.exact + speed(INSTANTS)) ** 2))

    def course(self):
        """x'' + w^2 x = f a(t), a polynomial a: x = p(t) - p(0) cos wt - p'(0)/w sin wt."""
        rows = []
        for square, pull in zip(self.squares, self.pull):
            w, term = np.sqrt(square), self.acceleration * float(pull / square)
            p = np.poly1d(0)
            while term.coef.any():
                p, term = p + term, term.deriv(2) * float(-1 / square)
            rows.append(p.deriv()(INSTANTS) + p(0) * w * np.sin(w * INSTANTS) - p.deriv()(0) * np.cos(w * INSTANTS))
        return self.tip @ np.array(rows)


class Cantilever:
    """Scene T in small motions: 20 m, clamped at one end, that bend under their weight from rest."""

    def __init__(self):
        elements, l = 80, 0.25
        line = DENSITY * np.pi / 4 * (OUTER ** 2 - INNER ** 2)
        bending = YOUNG * np.pi / 64 * (OUTER ** 4 - INNER ** 4)
        mass = line * l / 420 * np.array([[156, 22 * l, 54, -13 * l], [22 * l, 4 * l * l, 13 * l, -3 * l * l],
                                          [54, 13 * l, 156, -22 * l], [-13 * l, -3 * l * l, -22 * l, 4 * l * l]])
        stiffness = bending / l ** 3 * np.array([[12, 6 * l, -12, 6 * l], [6 * l, 4 * l * l, -6 * l, 2 * l * l],
                                                 [-12, -6 * l, 12, -6 * l], [6 * l, 2 * l * l, -6 * l, 4 * l * l]])
        weight = -9.81 * line * l * np.array([1 / 2, l / 12, 1 / 2, -l / 12])
        mass, stiffness, weight = assembled(elements, 2, mass, stiffness, weight)
        self.squares, shapes = eigh(stiffness[2:, 2:], mass[2:, 2:])
        self.weight, self.pull = shapes.T @ weight[2:], np.zeros_like(self.squares)
        self.tip, self.angle, self.acceleration = shapes[-2], np.poly1d(0), np.poly1d(0)
        self.output, self.scale = 0, 20.0  # the place of the tip, over the length
        swing = 1 - np.cos(np.sqrt(self.squares)[:, None] * INSTANTS)
        self.exact = self.tip @ ((self.weight / self.squares)[:, None] * swing)


def generalized_alpha(scene, h, radius=0.8):
    """With the support's angle given at the ends of steps, as the library gives that of a drive."""
    alpha_m, alpha_f = (2 * radius - 1) / (radius + 1), radius / (radius + 1)
    gamma = 0.5 + alpha_f - alpha_m
    beta = (gamma + 0.5) ** 2 / 4
    lead = 1 - alpha_m + (1 - alpha_f) * beta * h * h * scene.squares

    def predicted(x, v, a):
        return x + h * v + h * h * (0.5 - beta) * a, v + h * (1 - gamma) * a

    def corrected(x, v, a):
        return x + beta * h * h * a, v + gamma * h * a, a

    support = scene.angle(0.0), 0.0, scene.acceleration(0.0)
    x = v = np.zeros_like(scene.squares)
    force = scene.weight
    a = force + scene.pull * support[2]
    step = 0
    while True:
        step += 1
        s, s_v = predicted(*support)
        old, support = support[2], corrected(s, s_v, (scene.angle(step * h) - s) / (beta * h * h))
        x, v = predicted(x, v, a)
        a = (scene.pull * ((1 - alpha_m) * support[2] + alpha_m * old) - alpha_m * a + alpha_f * force +
             (1 - alpha_f) * (scene.weight - scene.squares * x)) / lead
        x, v, a = corrected(x, v, a)
        force = scene.weight - scene.squares * x
        yield x, v


def extrapolated(scene, h):
    """Two courses side by side, steps of h and h / 2, whose leading errors cancel in the results."""
    fine = generalized_alpha(scene, h / 2)
    for x, v in generalized_alpha(scene, h):
        next(fine)
        fine_x, fine_v = next(fine)
        yield (4 * fine_x - x) / 3, (4 * fine_v - v) / 3


def runge_kutta(scene, h, rows):
    """The stages' accelerations are the unknowns."""
    a = np.array(rows)
    c = a.sum(axis=1)
    b = a[-1] if np.isclose(c[-1], 1) else np.array([0.5, 0.5])
    system = np.eye(len(c)) + h * h * scene.squares[:, None, None] * (a @ a)
    x = v = np.zeros_like(scene.squares)
    step = 0
    while True:
        force = scene.weight[:, None] + scene.pull[:, None] * scene.acceleration((step + c) * h)
        right = force - scene.squares[:, None] * (x[:, None] + h * v[:, None] * c)
        stages = np.linalg.solve(system, right[:, :, None])[:, :, 0]
        x, v = x + h * v + h * h * stages @ (a.T @ b), v + h * stages @ b
        step += 1
        yield x, v


def error(scene, method, h):
    course, every = method(scene, h), round(INSTANTS[0] / h)
    ends = [state for _, state in zip(range(every * len(INSTANTS)), course)][every - 1::every]
    told = np.array([scene.tip @ state[scene.output] for state in ends])
    return np.sqrt(np.mean(((told - scene.exact) / scene.scale) ** 2))


def largest_step(scene, method):
    """The step in ms from which on the error stays below the goal, between tried ones by logarithms."""
    steps = INSTANTS[0] / 2 ** np.arange(1, 11)
    errors = np.array([error(scene, method, h) for h in steps])
    last = np.flatnonzero(errors > GOAL)[-1]
    return 1e3 * np.exp(np.interp(-np.log(GOAL), -np.log(errors[last:last + 2]), np.log(steps[last:last + 2])))


def main():
    methods = {"generalized-alpha": (1, generalized_alpha), "the same, extrapolated": (3, extrapolated)}
    for name, rows in RUNGE_KUTTA.items():
        methods[name] = len(rows), lambda scene, h, rows=rows: runge_kutta(scene, h, rows)
    cubic, quintic = (2 * np.pi * np.poly1d(p) for p in ([-2, 3, 0, 0], [6, -15, 10, 0, 0, 0]))
    print("| scene | method | stages | step ms | over ours | saves less than |\n|---|---|---|---|---|---|")
    for scene_name, scene in ("C", Tube(cubic)), ("C, smoother start", Tube(quintic)), ("T", Cantilever()):
        ours = largest_step(scene, generalized_alpha)
        for name, (stages, method) in methods.items():
            step = largest_step(scene, method)
            print(f"| {scene_name} | {name} | {stages} | {step:.2g} | {step / ours:.2g} | {step / ours / stages:.2g} |")


main()
