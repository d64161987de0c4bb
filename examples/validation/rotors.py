"""Rotors on bearings: natural frequencies by speed against a textbook's."""
import math

import numpy as np

import drillmbd as mbd
from case import Case, Row, case, picture

RPM = 2.0 * math.pi / 60.0
YOUNG, SHEAR, DENSITY, DIAMETER, LENGTH = 211e9, 81.2e9, 7810.0, 0.05, 1.5
BOOK = ("Friswell, Penny, Garvey, Lees, Dynamics of Rotating Machines, Cambridge University Press 2010, examples "
        "5.9.1, 5.9.2 "
        "and 5.9.9; their figures as the tests of the public program ross (petrobras/ross) carry them")
BOOK_DOI = "10.1017/CBO9780511780509"
#: Name: discs (x [m], diameter [m]), bearings (x [m], stiffness along y and z [N/m]), frequencies [rad/s] at 0 and 4000
#: rev/min.
ROTORS = {
    "two discs, isotropic bearings (5.9.1)": (((0.5, 0.28), (1.0, 0.35)), ((0.0, 1e6, 1e6), (1.5, 1e6, 1e6)), {
        0.0: (86.66, 86.66, 274.31, 274.31, 716.78, 716.78), 4000.0: (85.39, 87.80, 251.78, 294.71, 600.18, 827.08)}),
    "two discs, anisotropic bearings (5.9.2)": (((0.5, 0.28), (1.0, 0.35)), ((0.0, 1e6, 8e5), (1.5, 1e6, 8e5)), {
        0.0: (82.65, 86.66, 254.52, 274.31, 679.49, 716.79), 4000.0: (82.33, 86.86, 239.64, 287.25, 583.49, 806.89)}),
    "overhung disc (5.9.9)": (((1.5, 0.35),), ((0.0, 1e7, 1e7), (1.0, 1e7, 1e7)), {
        0.0: (90.14, 90.14, 630.73, 630.73, 830.43, 830.43), 4000.0: (76.19, 103.91, 565.99, 634.23, 647.75, 1174.2)})}


def section():
    """EA, GA, GA, GJ, EI, EI of the shaft; shear coefficient 6 (1 + nu)^2/(7 + 12 nu + 4 nu^2), as in the book."""
    nu, area, second = YOUNG / (2.0 * SHEAR) - 1.0, 0.25 * math.pi * DIAMETER ** 2, math.pi / 64.0 * DIAMETER ** 4
    across = 6.0 * (1.0 + nu) ** 2 / (7.0 + 12.0 * nu + 4.0 * nu * nu) * SHEAR * area
    return YOUNG * area, across, across, SHEAR * 2.0 * second, YOUNG * second, YOUNG * second


def disc_of(diameter, width=0.07):
    """Mass, moments of inertia about and across the axis of a disc on the shaft."""
    outer, inner = 0.5 * diameter, 0.5 * DIAMETER
    mass = DENSITY * math.pi * (outer ** 2 - inner ** 2) * width
    return mass, 0.5 * mass * (outer ** 2 + inner ** 2), mass * (3.0 * (outer ** 2 + inner ** 2) + width ** 2) / 12.0


def frequencies(name, rpm, elements=4, count=6):
    """[rad/s] lateral natural frequencies as they are seen from outside."""
    discs, bearings, _ = ROTORS[name]
    cuts = sorted({0.0, LENGTH, *(x for x, _ in discs), *(bearing[0] for bearing in bearings)})
    spinning = (0.0, 0.0, 0.0, rpm * RPM, 0.0, 0.0)
    with mbd.Model() as model:
        model.set_environment(gravity=(0.0, 0.0, 0.0))
        string = model.add_string(follows_hole=0, start_free=mbd.FREE_ALL, end_free=mbd.FREE_ALL, velocity=spinning)
        for start, end in zip(cuts, cuts[1:]):
            model.add_pipes(1, string=string, length=end - start, elements=elements, outer_diameter=DIAMETER,
                            inner_diameter=0.0, density=DENSITY, section_stiffness=section())

        def place(x):
            return mbd.station(string, len(cuts) - 2, 1.0) if x == LENGTH else mbd.station(string, cuts.index(x), 0.0)
        for x, diameter in discs:
            mass, about, across = disc_of(diameter)
            disc = model.add_body(mass=mass, inertia=(about, across, across, 0.0, 0.0, 0.0), position=(x, 0.0, 0.0),
                                  velocity=spinning)
            model.add_joint(place_a=place(x), place_b=mbd.station(disc), match=1)
        # the first also holds the shaft along its axis, which no lateral mode feels
        for x, along_y, along_z in bearings:
            model.add_joint(kind=mbd.JOINT_FREE, place_a=mbd.Place(), place_b=place(x), match=1, origin_a=(x, 0.0, 0.0),
                            stiffness=(1e8 if x == 0.0 else 0.0, along_y, along_z, 0.0, 0.0, 0.0))
        model.compile()
        with model.sim() as sim:
            modes = sim.modes(kind=mbd.MODES_DAMPED, axes=mbd.MODES_AXES_AT_REST, count=2 * count + 4)
            found = [modes[k] for k in range(modes.info.count)]
            return [mode.eigenvalue[1] for mode in found if not mode.rigid and mode.share[2] > 0.5][:count]


@case("rotors")
def rotors(pictures):
    rows = []
    for name, (_, _, tables) in ROTORS.items():
        for rpm, table in tables.items():
            for k, (want, got) in enumerate(zip(table, frequencies(name, rpm)), 1):
                rows.append(Row(f"{name}, {rpm:g} rev/min: frequency {k}", "rad/s", want, got, "4 elements a piece",
                                1e-3))
    def draw(axes):
        speeds = np.linspace(0.0, 4500.0, 19)
        for axis, name in zip(axes, ROTORS):
            axis.plot(speeds, [frequencies(name, rpm, 2) for rpm in speeds], "-", color="C0", linewidth=1)
            for rpm, table in ROTORS[name][2].items():
                axis.plot([rpm] * len(table), table, "o", color="C3", markersize=4)
            axis.plot(speeds, speeds * RPM, ":", color="#888888")
            axis.set(xlabel="speed [rev/min]", title=name)
        axes[0].set(ylabel="natural frequency [rad/s]")
    return Case("rotors", "Rotors on bearings: natural frequencies by speed", "published", BOOK, BOOK_DOI,
                "shaft of 1.5 m and 50 mm, E 211 GPa, G 81.2 GPa, 7810 kg/m³; discs 70 mm thick; bearings of 1 MN/m, "
                "1 and 0.8 MN/m, 10 MN/m", "nothing", rows,
                "The book's figures come from six elements; points in the picture. Dotted: once a revolution.",
                pictures=[picture(draw, 3, 10.5, 3.4)] if pictures else [])
