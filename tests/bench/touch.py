#!/usr/bin/python3
"""A mass falls on a wall k d + c d', as the string of scene B does, by several ways of taking the touch within a step.

usage: tests/bench/touch.py

m d'' = m g - F, F = max(0, k d + c d') while d > 0, all for a metre of scene B's tube; fallen from a little more than
the clearance, seven heights so that touch comes anywhere in a step; depth after 0.1 s against the closed form, root
mean square over the clearance.
"""
import math

MASS, STIFFNESS, DAMPING, GRAVITY, CLEARANCE, END = 11.4, 1e6, 1e3, 9.81, 0.0105, 0.1
STEPS = [1e-3 / 2**i for i in range(5)]
SPECTRAL_RADIUS = 0.8
LOCATED = "steps that end at touch and opening"


def exact(gap):
    fall = math.sqrt(2 * gap / GRAVITY)
    b, rest = 0.5 * DAMPING / MASS, MASS * GRAVITY / STIFFNESS
    w = math.sqrt(STIFFNESS / MASS - b * b)
    cosine, sine = -rest, (GRAVITY * fall - b * rest) / w

    def pressed(t):
        decay, c, s = math.exp(-b * t), math.cos(w * t), math.sin(w * t)
        d = decay * (cosine * c + sine * s)
        return rest + d, decay * w * (sine * c - cosine * s) - b * d

    low, high = 1e-4, 0.02
    for _ in range(60):
        d, v = pressed(0.5 * (low + high))
        if STIFFNESS * d + DAMPING * v > 0:
            low = 0.5 * (low + high)
        else:
            high = 0.5 * (low + high)
    d, v = pressed(low)
    t = END - fall - low
    return d + v * t + 0.5 * GRAVITY * t * t


class Mass:
    """A mass in steps of generalized-alpha; `way` says how a step takes touch and opening."""

    def __init__(self, gap, way):
        r = SPECTRAL_RADIUS
        self.am, self.af = (2 * r - 1) / (r + 1), r / (r + 1)
        self.gamma = 0.5 + self.af - self.am
        self.beta = (self.gamma + 0.5)**2 / 4
        self.way, self.d, self.v, self.dv, self.a = way, -gap, 0.0, GRAVITY, GRAVITY
        self.age, self.part, self.length = 0, 0.0, 0.0
        self.closed, self.parts = False, 0

    def damping_weight(self, d):
        """[-] of the damping at the depth d > 0."""
        first = 11 / 6
        if self.way == "weights over three steps":
            if self.d <= 0:
                return first * d / (d - self.d)
            p = self.part
            return {1: first - 5 / 3 * p + p * p / 2, 2: 2 / 3 + 5 / 6 * p - p * p / 2}.get(self.age, 1.0)
        if self.way == "weights over two steps":
            if self.d <= 0:
                return 1.5 * d / (d - self.d)
            return 1.5 - 0.5 * self.part if self.age == 1 else 1.0
        if self.way == "weight p + 1/2 in one step" and self.d <= 0:
            return 0.5 + d / (d - self.d)
        return 1.0

    def force(self, d, v, h):
        if self.way == LOCATED:
            return STIFFNESS * d + DAMPING * v if self.closed else 0.0
        if self.way == "discrete gradient":
            # the mean of the elastic force over the way, damping by the closed part of the step
            if d <= 0 and self.d <= 0:
                return 0.0
            stored = 0.5 * STIFFNESS * (max(d, 0)**2 - max(self.d, 0)**2)
            elastic = stored / (d - self.d) if d != self.d else STIFFNESS * max(d, 0)
            return max(0.0, elastic + DAMPING * (max(d, 0) - max(self.d, 0)) / h)
        return max(0.0, STIFFNESS * d + self.damping_weight(d) * DAMPING * v) if d > 0 else 0.0

    def trial(self, acceleration, h, start):
        dv, a0 = start
        a1 = ((1 - self.af) * acceleration + self.af * dv - self.am * a0) / (1 - self.am)
        d = self.d + h * self.v + h * h * ((0.5 - self.beta) * a0 + self.beta * a1)
        v = self.v + h * ((1 - self.gamma) * a0 + self.gamma * a1)
        if self.way == "discrete gradient":  # the midpoint rule
            a1 = acceleration
            v = self.v + h * a1
            d = self.d + 0.5 * h * (self.v + v)
        if self.way == "impulses at the end of the step":  # the smooth part without contact, then an impulse
            a1 = GRAVITY
            smooth = self.v + h * GRAVITY
            v = smooth + h * (acceleration - GRAVITY)
            d = self.d + h * self.v + 0.5 * h * h * GRAVITY + 0.5 * h * (v - smooth)
        return d, v, a1

    def solve(self, h, start):
        low, high = -5e3, 5e3
        for _ in range(80):
            x = 0.5 * (low + high)
            d, v, _ = self.trial(x, h, start)
            if x - GRAVITY + self.force(d, v, h) / MASS > 0:
                high = x
            else:
                low = x
        x = 0.5 * (low + high)
        return (x, *self.trial(x, h, start))

    def attempt(self, h):
        ratio = h / self.length if self.length else 1.0
        start = (self.dv, self.dv + ratio * (self.a - self.dv))
        x, d, v, a = self.solve(h, start)
        if self.way in ("discrete gradient", "impulses at the end of the step", LOCATED):
            return x, d, v, a
        before, after = STIFFNESS * self.d + DAMPING * self.v, STIFFNESS * d + DAMPING * v
        if self.way == "as it is at the end of the step":
            before, after = (max(before, 0.0), d) if self.d > 0 else (0.0, d)
            part = d / (d - self.d) if d != self.d else 0.0
        else:
            part = after / (after - before) if after != before else 0.0
        if self.d > 0 and before > 0 and after <= 0:  # it opens: its force is taken off the history in part
            dv = self.dv + part * before / MASS
            x, d, v, a = self.solve(h, (dv, dv + (1 - part) * ratio * (self.a - self.dv)))
        return x, d, v, a

    def take(self, h, result):
        x, d, v, a = result
        self.age = 1 if self.d <= 0 < d else self.age + 1
        if self.age == 1:
            self.part = d / (d - self.d)
        self.dv, self.d, self.v, self.a, self.length = x, d, v, a, h

    def changes(self, d, v):
        """True where a mass in the air is in the wall, or the force of one on it has come to 0."""
        return STIFFNESS * d + DAMPING * v <= 0 if self.closed else self.d <= 0 < d

    def step_to_event(self, h):
        """A step that ends where touch or opening is, by halving its length; what of it is left."""
        low, high = 0.0, h
        for _ in range(50):
            middle = 0.5 * (low + high)
            if self.changes(*self.attempt(middle)[1:3]):
                high = middle
            else:
                low = middle
        self.take(high, self.attempt(high))
        self.parts += 1
        self.closed = not self.closed
        if self.closed:
            self.d = 0.0
        self.dv = self.a = GRAVITY - self.force(self.d, self.v, h) / MASS  # the scheme begins anew
        return h - high

    def step(self, h):
        if self.way != LOCATED:
            return self.take(h, self.attempt(h))
        while h > 0 and self.changes(*self.attempt(h)[1:3]):
            h = self.step_to_event(h)
        if h > 0:
            self.take(h, self.attempt(h))


def error(way, h):
    total = 0.0
    for i in range(7):
        gap = CLEARANCE * (1 + 0.04 * h / 1e-3 * i / 6)
        mass = Mass(gap, way)
        for _ in range(round(END / h)):
            mass.step(h)
        total += ((mass.d - exact(gap)) / CLEARANCE)**2 / 7
    return math.sqrt(total)


def main():
    print("| touch within a step | " + " | ".join(f"{1e3 * h:g} ms" for h in STEPS) + " |")
    print("|---|" + "---|" * len(STEPS))
    for way in ("as it is at the end of the step", "impulses at the end of the step", "discrete gradient",
                "weight p + 1/2 in one step", "weights over two steps", "weights over three steps", LOCATED):
        print(f"| {way} | " + " | ".join(f"{error(way, h):.1e}" for h in STEPS) + " |", flush=True)


if __name__ == "__main__":
    main()
