"""Axial self-excited vibration of a distributed string by the regenerative law of the bit: exponents of the motion
against the roots of the characteristic equation."""
import cmath
import math

import numpy

import drillmbd as mbd
from case import Case, Row, case, picture

OUTER, INNER, YOUNG, DENSITY, LENGTH = 0.127, 0.108, 200e9, 8e3, 2000.0          # of the string [m, Pa, kg/m3]
RADIUS, ENERGY, RATIO, BLADES = 0.108, 60e6, 0.6, 4                              # of bit and rock [m, Pa, -, -]
DAMPING, FEED, BIT_MASS = 0.5, 30.0 / 3600.0, 5.0                                # [1/s, m/s, kg]
AREA = math.pi / 4.0 * (OUTER ** 2 - INNER ** 2)
CUTTING = RADIUS * RATIO * ENERGY * BLADES                                       # [N/m] of the depth that a blade cuts
#: Speed of rotation [rev/min], damping time of the material [s], behaviour.
CONDITIONS = ((100.0, 1e-3, "unstable"), (60.0, 1e-3, "unstable"), (100.0, 3e-3, "stable"))
ELEMENTS, STEP, END, FIRST, SAMPLING, ORDER = 100, 1e-3, 8.0, 3.0, 10, 8


def balance(s, speed, tau):
    """Sum of the axial forces at the bit over its velocity, with a head that holds its speed:

        Z coth(g L) + M s + K (1 - exp(-s t_n))/s = 0,   Z = E' A g/s,   g^2 = rho A s (s + k)/(E' A),   E' = E (1 + tau
        s),

    with the delay t_n = 2 pi/(n Omega) of one blade spacing and K = n a zeta eps."""
    stiffness = YOUNG * AREA * (1.0 + tau * s)
    g = cmath.sqrt(DENSITY * AREA * s * (s + DAMPING) / stiffness)
    g = g if g.real > 0.0 else -g
    back = cmath.exp(-2.0 * g * LENGTH)
    return (stiffness * g / s * (1.0 + back) / (1.0 - back) + BIT_MASS * s
            + CUTTING / s * (1.0 - cmath.exp(-2.0 * math.pi * s / (BLADES * speed))))


def root_near(start, speed, tau):
    """Newton's method from a start; None where it leaves the upper half plane."""
    s = start
    for _ in range(60):
        slope = (balance(s + 1e-6, speed, tau) - balance(s - 1e-6, speed, tau)) / 2e-6
        change = balance(s, speed, tau) / slope
        s -= change * min(1.0, 3.0 / max(abs(change), 1e-30))
        if s.imag < 0.3 or abs(s.real) > 20.0:
            return None
        if abs(change) < 1e-11:
            return s
    return None


def roots(rpm, tau, highest=400.0):
    """[1/s] the roots with 0.3 < Im s < highest that Newton's method finds, the fastest growing first."""
    found = []
    for number in range(int(highest / 1.3)):
        for growth in (-1.0, 0.0, 1.0):
            s = root_near(complex(growth, 1.0 + 1.3 * number), rpm * math.pi / 30.0, tau)
            if s is not None and not any(abs(s - one) < 1e-5 for one in found):
                found.append(s)
    return sorted(found, key=lambda s: -s.real)


def motion(rpm, tau, elements=ELEMENTS, step=STEP, end=END):
    """Times and weight on the bit less that of steady drilling [s, N], after a pulse of the feed of 0.2 mm/s."""
    speed = rpm * math.pi / 30.0
    with mbd.Model() as model:
        model.set_environment(gravity=(0.0, 0.0, 0.0), axial_damping=DAMPING * DENSITY * AREA)
        model.add_wall(diameter=0.311, direction=(1.0, 0.0, 0.0), mu_dynamic=0.0, mu_static=0.0)
        model.add_pipes(elements, kind=mbd.PIPE_AXIAL_TORSIONAL, length=LENGTH / elements, outer_diameter=OUTER,
                        inner_diameter=INNER,
                        young_modulus=YOUNG, density=DENSITY, damping_time=tau)
        bit = model.add_bit(rock_law=mbd.ROCK_REGENERATIVE, mass=BIT_MASS, inertia=(1e9, 1e9), diameter=2.0 * RADIUS,
                            radius=RADIUS, intrinsic_energy=ENERGY,
                            cutting_ratio=RATIO, contact_strength=0.0, wear_length=0.0, blades=BLADES, history=4096)
        model.add_drive(component=mbd.X, time_function=model.add_time_function(FEED),
                        excitation=model.add_time_function(mbd.Segment(table=[(0.0, 0.0), (0.05, 2e-4), (0.1, 0.0)])))
        model.add_drive(component=mbd.RX, time_function=model.add_time_function(speed))
        model.compile()
        with model.sim() as sim:
            sim.static()
            steady, weight = sim.bit(bit).weight, []
            for _ in range(round(end / step)):
                sim.step(step)
                weight.append(sim.bit(bit).weight - steady)
    return step * numpy.arange(1, len(weight) + 1), numpy.array(weight)


def exponents(values, spacing, order=ORDER):
    """[1/s] s_k of values = sum of c_k exp(s_k t) by the matrix pencil (Hua, Sarkar 1990), the fastest growing
    first."""
    count = len(values) // 2
    hankel = numpy.array([values[i:i + count] for i in range(len(values) - count)])
    shapes = numpy.linalg.svd(hankel, full_matrices=False)[2][:order].T
    found = numpy.log(numpy.linalg.eigvals(numpy.linalg.pinv(shapes[:-1]) @ shapes[1:]).astype(complex)) / spacing
    return sorted((complex(s) for s in found if s.imag > 1.0), key=lambda s: -s.real)


def fastest(times, weight, step):
    """[1/s] the exponent that grows fastest, from samples 10 ms apart."""
    sampling = round(SAMPLING * STEP / step)
    return exponents(weight[times > FIRST][::sampling], sampling * step)[0]


def growth_error(got, want):
    """In percent of the growth."""
    return f"{100.0 * abs(got.real / want.real - 1.0):.1f}"


@case("regenerative")
def regenerative(pictures):
    rows, curves, errors = [], [], []
    for rpm, tau, state in CONDITIONS:
        want, (times, weight) = roots(rpm, tau)[0], motion(rpm, tau)
        got = fastest(times, weight, STEP)
        errors.append(growth_error(got, want))
        words = f"{rpm:g} rev/min, {1e3 * tau:g} ms, {state}"
        used = f"{ELEMENTS} elements, {1e3 * STEP:g} ms, motion from {FIRST:g} to {END:g} s"
        rows += [Row(f"growth at {words}", "1/s", want.real, got.real, used, 1e-4, scale=abs(want)),
                 Row(f"angular frequency at {words}", "rad/s", want.imag, got.imag, used, 2e-4)]
        curves.append((words, want, times, weight))

    (rpm, tau, _), coarse = CONDITIONS[0], 2.0 * STEP
    twice = growth_error(fastest(*motion(rpm, tau, step=coarse), coarse), roots(rpm, tau)[0])

    def draw(axes):
        for color, (words, want, times, weight) in zip(("C0", "C1", "C2"), curves):
            axes.semilogy(times, abs(weight) + 1e-3, color=color, linewidth=0.4)
            size = abs(weight[times > FIRST]).max() if want.real < 0.0 else abs(weight).max()
            anchor = FIRST if want.real < 0.0 else END
            axes.semilogy([FIRST, END], [size * math.exp(want.real * (time - anchor)) for time in (FIRST, END)], "--",
                          color=color, label=words)
        axes.set(xlabel="time [s]", ylabel="weight on the bit less 19.4 or 32.4 kN [N]")
        axes.legend()
    return Case("regenerative", "Axial self-excited vibration of a string that cuts what its last blade left",
                "published",
                "Aarsnes, Aamo 2016, J. Sound and Vibration 360, 239 (PII S0022460X15007385): distributed string with "
                "the linear regenerative law; parameters: "
                "file of the axial model in the public repository ulfjakob/AxialTorsionalDrillString", "",
                "string, bit, rock, viscous damping, feed and law of the file; speeds of 60 and 100 rev/min and the "
                "damping of the material, which leaves one "
                "root unstable or none, are chosen here and stand in equation and scene; bit of 5 kg that turns evenly "
                "(1e9 kg m2), no wear flats, no gravity",
                "nothing", rows,
                f"The errors of the growth are over |s|; over the growth itself they are {', '.join(errors)} % (with "
                f"steps of 2 ms {twice} % in the "
                "first row). The dashed lines of the picture have the slope of the roots. Roots that the authors' "
                "repository is said to give (0.1371 + 42.427i and two "
                "others) are not compared: the parameters that belong to them were not found.",
                pictures=[picture(draw)] if pictures else [])
