"""Work against error of a turning tube, beside other multibody programs at the step that they were measured with."""
import math
import time

import numpy

import drillmbd as mbd
from case import Case, Row, case, picture
from scipy.linalg import lapack

PIPES, OUTER, INNER, YOUNG, POISSON, DENSITY = 100, 0.073, 0.059, 206e9, 0.3, 7850.0
END, STEPS = 2.0, (16e-3, 8e-3, 4e-3, 2e-3, 1e-3, 5e-4)
UNIT = 49.4e-6  #: [s] of the unit of work where the others were measured: 45.6 to 53.1 us
#: Program and settings, time of a step of 1 ms [s], relative error of the rotation of the free end at 2 s; measured
#: 2026-11-26 in one run on an AMD EPYC
#: (Zen 5), one thread, set-up excluded, median of five turns in alternation.
OTHERS = (("libdrillmbd 85d409c2, defaults", 8.3e-6, 1.0e-6, "o"),
          ("MBDyn develop 59e50fa, best: -Ofast, UMFPACK, modified Newton, Jacobian kept 1000 iterations, tolerance "
           "1e-4", 139e-6, 1.1e-6, "s"),
          ("MBDyn develop 59e50fa: naive solver, colamd, Jacobian kept 100 iterations", 190e-6, 1.1e-6, "D"),
          ("Exudyn 1.11.0, best: fast module, -O3, sparse LU, modified Newton, rtol 1e-4, Tait-Bryan nodes", 217e-6,
           1.1e-6, "^"),
          ("MBDyn develop 59e50fa, defaults: UMFPACK, full Newton", 1265e-6, 1.1e-6, "v"))


def drive(t):
    """Speed, its rate and its integral: pi (1 - cos pi t) for 1 s, then 2 pi."""
    if t < 1.0:
        return (math.pi * (1.0 - math.cos(math.pi * t)), math.pi ** 2 * math.sin(math.pi * t),
                math.pi * t - math.sin(math.pi * t))
    return 2.0 * math.pi, 0.0, math.pi + 2.0 * math.pi * (t - 1.0)


def exact(t):
    """[rad] rotation of the free end: the driven rotation R comes after the passage T and is doubled; at the driven end
    it turns over,
    2 R(t - T) - 2 R(t - 3T) + ..., T = L sqrt(rho/G) (d'Alembert)."""
    passage = PIPES * math.sqrt(DENSITY / (YOUNG / (2.0 * (1.0 + POISSON))))
    total, sign, at = 0.0, 2.0, t - passage
    while at > 0.0:
        total, sign, at = total + sign * drive(at)[2], -sign, at - 2.0 * passage
    return total


def run(step):
    """[rad] rotation of the free end, [s] of a processor for the steps."""
    with mbd.Model() as model:
        string = model.add_string(start_free=mbd.FREE_RX)
        model.add_pipes(PIPES, string=string, length=1.0, outer_diameter=OUTER, inner_diameter=INNER,
                        young_modulus=YOUNG, poisson_ratio=POISSON, density=DENSITY)
        speed = model.add_time_function(mbd.Segment(function=drive, provides=mbd.PROVIDES_RATE | mbd.PROVIDES_INTEGRAL))
        model.add_drive(part=string, component=mbd.RX, time_function=speed)
        model.compile(features=0)
        with model.sim() as sim:
            began = time.process_time()
            sim.steps(step, round(END / step))
            spent = time.process_time() - began
            return sim.rotation(mbd.station(string, PIPES - 1, 1.0)), spent


def unit():
    """[s] the unit of work: LAPACK's band Cholesky factors and one solution of 606 equations with half band 11."""
    band = numpy.zeros((12, 606))
    band[0], band[1:] = 30.0, -1.0
    right, least = numpy.ones((606, 1)), math.inf
    for _ in range(300):
        began = time.perf_counter()
        factors, _ = lapack.dpbtrf(band, lower=1)
        lapack.dpbtrs(factors, right, lower=1)
        least = min(least, time.perf_counter() - began)
    return least


@case("work")
def work(pictures):
    want, rows, points = exact(END), [], []
    for step in STEPS:
        got, spent = run(step)
        rows.append(Row("rotation of the free end at 2 s", "rad", want, got, f"100 elements, {1e3 * step:g} ms",
                        2e-6 if step <= 1e-3 else None))
        if pictures:
            points.append((abs(rows[-1].error), min([spent] + [run(step)[1] for _ in range(2)]) / END))

    def draw(axes):
        scale = unit()
        axes.loglog([error for error, _ in points], [spent / scale for _, spent in points], "-o", color="C0",
                    markersize=3, linewidth=1.0,
                    label="this build, steps of 16 to 0.5 ms, drive by a function of Python")
        for number, (name, spent, error, marker) in enumerate(OTHERS):
            axes.loglog([error], [spent / 1e-3 / UNIT], marker, color=f"C{number}", markersize=6,
                        label=f"{name.split(':')[0]}, 1 ms")
        axes.set(xlabel="relative error of the rotation", ylabel="work for a second [U]")
        axes.legend(loc="upper right", fontsize=7)
    return Case("work", "Work against error: a turning tube, beside MBDyn and Exudyn", "published",
                "closed form (d'Alembert); MBDyn and Exudyn were measured beside the library, settings by some 60 "
                "trials", "",
                "tube of 100 m turned at one end by pi (1 - cos pi t) rad/s for 1 s, then by 2 pi; free at the other "
                "end; defaults of the library", "nothing", rows,
                "The picture has the work in U, a factorisation and solution of 606 equations with half band 11 by "
                "LAPACK, which is measured with the page (49.4 us where "
                "the others were measured: 2026-11-26, AMD EPYC of the kind Zen 5, one thread, set-up excluded, median "
                "of five turns in alternation). " + "; ".join(f"{name}: {1e6 * spent:.4g} us a step, error {error:.2g}"
                                                              for name, spent, error, _ in OTHERS)
                + ". Times of a loaded machine are upper bounds.",
                pictures=[picture(draw, height=4.0)] if pictures else [])
