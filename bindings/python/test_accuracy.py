"""Recomputes each row of the table of measured errors in the user's guide and compares it with the guide.
`python test_accuracy.py --table` prints the rows for the guide."""
from __future__ import annotations

import math
import pathlib
import re
import sys
import unittest
from collections.abc import Callable

import drillmbd as mbd

LIMITS = pathlib.Path(__file__).resolve().parents[2] / "lib" / "theory" / "limits.md"
GUIDE = pathlib.Path(__file__).resolve().parents[2] / "examples" / "README.md"
OUTER, INNER, E = 0.073, 0.055, 210e9
AREA = math.pi / 4 * (OUTER**2 - INNER**2)
EI = E * math.pi / 64 * (OUTER**4 - INNER**4)


def clamped(elements, length=10.0, force=None, curvature=0.0, **section):
    """A clamped pipe without weight, pushed by a force [N] at its far end, in equilibrium."""
    model = mbd.Model()
    model.set_environment(gravity=(0.0, 0.0, 0.0))
    string = model.add_string(follows_hole=0, start_free=mbd.FREE_NONE)
    fields = {"outer_diameter": OUTER, "inner_diameter": INNER, "young_modulus": E, **section}
    model.add_pipes(1, string=string, length=length, elements=elements, curvature=(0.0, curvature, 0.0), **fields)
    if force is not None:
        model.add_load(place=mbd.station(string, 0, 1.0), force=force)
    model.compile()
    sim = model.sim()
    if force is not None:
        sim.static()
    return sim, string


def frequency(elements, curvature):
    """[Hz] highest of the three lowest pairs."""
    return clamped(elements, curvature=curvature)[0].modes(count=6).frequencies[5]


def frequency_error(elements, curvature):
    return frequency(elements, curvature) / frequency(128, curvature) - 1.0


def tip_under_pull(pull):
    """Sideways deflection of one element of 3 m, 50/39 mm, against F/(N k) (k L - tanh k L) of the beam, k^2 = N/EI;
    without shear and stretch, which that leaves out (stiffnesses 1e4 times as large)."""
    length, force = 3.0, 1.0
    bending = E * math.pi / 64 * (0.05**4 - 0.039**4)
    axial = 1e4 * E * math.pi / 4 * (0.05**2 - 0.039**2)
    sim, string = clamped(1, length, (pull, 0.0, force), outer_diameter=0.05, inner_diameter=0.039,
                          section_stiffness=(axial, axial, axial, bending, bending, bending))
    k = math.sqrt(abs(pull) / bending)
    right = (k * length - math.tanh(k * length) if pull > 0 else math.tan(k * length) - k * length) / (abs(pull) * k)
    return sim.pose(mbd.station(string, 0, 1.0)).displacement[2] / (force * right) - 1.0


def column_error(elements):
    """Buckling load of a clamped column of 10 m; shear and stretch 1e4 times stiffer, which Euler leaves out."""
    model = mbd.Model()
    model.set_environment(gravity=(0.0, 0.0, 0.0))
    string = model.add_string(follows_hole=0, start_free=mbd.FREE_NONE)
    model.add_pipes(1, string=string, length=10.0, elements=elements, outer_diameter=OUTER, inner_diameter=INNER,
                    section_stiffness=(1e4 * E * AREA, 1e4 * E * AREA, 1e4 * E * AREA, EI, EI, EI))
    load = model.add_load(place=mbd.station(string, 0, 1.0), force=(-1.0, 0.0, 0.0))
    model.compile()
    sim = model.sim()
    sim.static()
    factor = 1.0 + sim.buckling(scale=mbd.SCALE_PART, part=load).factors[0]  # on top of the present force
    return factor / (math.pi**2 * EI / 4 / 10.0**2) - 1.0


def restitution_error():
    """Of a ball that meets the wall at 1 m/s, for 0.4."""
    model = mbd.Model()
    model.set_environment(gravity=(0.0, 0.0, 0.0))
    model.add_wall(diameter=0.2, restitution=0.4)
    ball = model.add_body(mass=1.0, inertia=(0.01, 0.01, 0.01, 0, 0, 0), position=(1.0, 0.0, 0.0),
                          velocity=(0, 0, -1.0, 0, 0, 0), contact_diameter=0.1, contact_length=0.1)
    model.compile()
    sim = model.sim(tolerance_translation=1e-10, tolerance_rotation=1e-10)
    sim.advance(0.1)
    return sim.motion(ball).velocity[2] / 0.4 - 1.0


def energy_of_coarse_bounces():
    """Largest energy of a rod with play in its joint over 1 s of bounces at 2 ms a step, far from resolved, less 1 J of
    the start."""
    model = mbd.Model()
    model.set_environment(gravity=(0.0, 0.0, 0.0))
    rod = model.add_body(mass=12.0, inertia=(0.02, 1.0, 1.0, 0, 0, 0))
    pin = mbd.JointDef(kind=mbd.JOINT_REVOLUTE, place_b=rod, initial_mask=mbd.FREE_RX)
    pin.stop_low[mbd.RX], pin.stop_high[mbd.RX], pin.initial_speed[mbd.RX] = -0.1, 0.1, 10.0
    model.add_joint(pin)
    model.compile()
    sim, most = model.sim(), 0.0
    for _ in range(500):
        sim.step(2e-3)
        energy = sim.energy()
        most = max(most, energy.kinetic + energy.strain)
    return most - 1.0


def momentum_error():
    """Of a pipe bent by 1 rad in one element, in translation."""
    model = mbd.Model()
    string = model.add_string(follows_hole=0, start_free=mbd.FREE_ALL, velocity=(1.0, 0, 0, 0, 0, 0))
    model.add_pipes(1, string=string, length=1.0, curvature=(0.0, 1.0, 0.0))
    model.compile()
    momentum = model.sim().momentum()
    return momentum.linear[0] / momentum.mass - 1.0


def static_friction_error():
    """Largest pull that a body on the low side, which does not roll, holds over mu_static of its weight, by halving."""
    low, high = 0.30, 0.40
    while high - low > 1e-5:
        pull = 0.5 * (low + high)
        model = mbd.Model()
        model.set_environment(gravity=(0.0, 0.0, -9.81))
        model.add_wall(diameter=0.2, mu_static=0.35, mu_dynamic=0.3)
        body = model.add_body(mass=1.0, inertia=(0.01, 0.01, 0.01, 0, 0, 0), position=(1.0, 0.0, -0.05),
                              contact_diameter=0.1, contact_length=0.1, free_mask=mbd.FREE_XZ)
        ramp = model.add_time_function(mbd.Segment(table=[(0.0, 0.0), (0.5, 1.0), (9.0, 1.0)]))
        model.add_load(place=body, force=(pull * 9.81, 0.0, 0.0), time_function=ramp)
        model.compile()
        sim = model.sim()
        sim.static()
        for _ in range(600):
            sim.step(5e-3)
        low, high = (low, pull) if sim.motion(body).velocity[0] > 0.05 else (pull, high)
    return low / 0.35 - 1.0


def deflection_error():
    """Of one element of 10 m under a small force at its end, against Timoshenko's beam: F L^3/(3 EI) + F L/(GA)."""
    shear = E * AREA / 2.6
    sim, string = clamped(1, force=(0.0, 0.0, 1e-2),
                          section_stiffness=(E * AREA, shear, shear, EI / 1.3, EI, EI))
    right = 1e-2 * (10.0**3 / (3 * EI) + 10.0 / shear)
    return sim.pose(mbd.station(string, 0, 1.0)).displacement[2] / right - 1.0


def oscillation(ratio, radius, place, speed, steps):
    """Course of (x, v/w) of 1 kg on a spring, w = ratio/h, by steps h of 1 ms; place and speed are those of x and v/w
    at the start, in 0.1 mm."""
    model, w = mbd.Model(), ratio / 1e-3
    model.set_environment(gravity=(0.0, 0.0, 0.0))
    body = model.add_body(mass=1.0, inertia=(1.0, 1.0, 1.0, 0, 0, 0), position=(1e-4 * place, 0.0, 0.0),
                          velocity=(1e-4 * speed * w, 0, 0, 0, 0, 0))
    model.add_spring(place_b=body, offset_a=(-10.0, 0.0, 0.0), free_length=10.0, stiffness=w * w)
    model.compile()
    sim, course = model.sim(spectral_radius=radius), []
    for _ in range(steps):
        sim.step(1e-3)
        course.append((1e4 * sim.pose(body).displacement[0] + place, 1e4 * sim.motion(body).velocity[0] / w))
    return course


def largest_energy(ratio, radius):
    """Over the initial one, of all initial states c: |S c|^2/|c|^2, S = [a b] of two courses, is at most (p + r +
    sqrt((p - r)^2 + 4 q^2))/2 with p = a.a, q = a.b, r = b.b. The steps end before rounding is all that is left."""
    most, steps = 1.0, 6 if radius == 0.0 else 15 if radius < 0.6 else 60
    for a, b in zip(oscillation(ratio, radius, 1.0, 0.0, steps), oscillation(ratio, radius, 0.0, 1.0, steps)):
        p, q, r = (x[0] * y[0] + x[1] * y[1] for x, y in ((a, a), (a, b), (b, b)))
        most = max(most, 0.5 * (p + r + math.hypot(p - r, 2.0 * q)))
    return most


#: by the guide's first column: against what, and the error
ROWS: dict[str, tuple[str, Callable[[], float]]] = {
    "deflection of a clamped pipe, 1 element": ("Timoshenko's beam", deflection_error),
    "deflection under a pull of 120 kN, 3 m of 50/39 mm, 1 element": ("closed form", lambda: tip_under_pull(120e3)),
    "deflection under a push of 8 kN, 3 m of 50/39 mm, 1 element": ("closed form", lambda: tip_under_pull(-8e3)),
    "buckling load of a clamped pipe, 2 elements": ("Euler", lambda: column_error(2)),
    "buckling load of a clamped pipe, 8 elements": ("Euler", lambda: column_error(8)),
    "third bending frequency of a clamped pipe, 4 elements": ("128 elements", lambda: frequency_error(4, 0.0)),
    "third bending frequency of a clamped pipe, 8 elements": ("128 elements", lambda: frequency_error(8, 0.0)),
    "the same of a pipe bent by 1 rad, 8 elements": ("128 elements", lambda: frequency_error(8, 0.1)),
    "momentum of a pipe bent by 1 rad in one element": ("mass times speed", momentum_error),
    "restitution of the default wall, 0.4 at 1 m/s": ("0.4", restitution_error),
    "largest pull that static friction holds": ("`mu_static` times weight", static_friction_error),
    "energy gained in bounces shorter than a step": ("energy at the start", energy_of_coarse_bounces),
}
NOTHING = 1e-4  #: errors below it are stated as that, because their digits depend on tolerances


def stated(error: float) -> str:
    return f"below {NOTHING:g}" if abs(error) < NOTHING else f"{error:.1e}"


def rows_measured() -> list[str]:
    return [f"| {what} | {against} | {stated(error())} |" for what, (against, error) in ROWS.items()]


class AccuracyTest(unittest.TestCase):
    def test_table_of_the_guide(self):
        table = re.search(r"^\| measured \| against \| error \|\n\|---\|---\|---\|\n((?:\|.*\n)+)",
                          GUIDE.read_text(encoding="utf-8"), re.M)
        self.assertIsNotNone(table)
        self.assertEqual(table.group(1).splitlines(), rows_measured())

    def test_energy_of_motions_that_steps_do_not_resolve(self):
        text = " ".join(LIMITS.read_text(encoding="utf-8").split())
        wanted = ", ".join("{:.3g}, {:.3g} and {:.3g} {} {:g}".format(
            *(largest_energy(ratio, radius) for ratio in (3.0, 10.0, 100.0)),
            "times the initial energy with spectral radius" if radius == 0.0 else "with", radius)
                           for radius in (0.0, 0.5, 0.8, 0.95))
        self.assertIn(wanted + ", and never above it with 1 (", text)
        self.assertLess(max(largest_energy(ratio, 1.0) for ratio in (3.0, 10.0, 100.0)), 1.0 + 1e-6)


if __name__ == "__main__":
    if sys.argv[1:] == ["--table"]:
        print("\n".join(rows_measured()))
    else:
        unittest.main()
