"""Losses of flow, strength and critical speeds of pipes: textbook examples and tables."""
import math

import drillmbd as mbd
from case import Case, Row, case

PSI, GALLON_MINUTE, POUND_GALLON, INCH = 6894.757, 0.0037854118 / 60.0, 119.826427, 0.0254
FOOT, POUND = 0.3048, 4.4482216  # [m, N]


@case("nozzles")
def nozzles(pictures):
    flow, density, area = 400.0 * GALLON_MINUTE, 12.0 * POUND_GALLON, 3.0 * math.pi / 4.0 * (12.0 / 32.0 * INCH) ** 2
    with mbd.Model() as model:
        model.add_wall(diameter=8.5 * INCH, direction=(0.0, 0.0, -1.0))
        model.set_environment(fluid_density=density, flow_rate=flow, consistency=0.02, nozzle_area=area)
        model.add_pipes(10, length=30.0, outer_diameter=5.0 * INCH, inner_diameter=4.276 * INCH)
        model.add_bit(mass=1.0, diameter=0.0)
        model.compile()
        with model.sim() as sim:
            loss = sim.flow().bit_loss
    loss_by_hand = density * flow ** 2 / (2.0 * 0.95 ** 2 * area ** 2)
    rows = [Row("pressure loss over the bit, published", "psi", 1610.0, loss / PSI, "", 0.001),
            Row("against rho Q^2/(2 Cd^2 A^2), Cd 0.95", "psi", loss_by_hand / PSI, loss / PSI, "", 1e-9)]
    return Case("nozzles", "Pressure loss over the nozzles of a bit", "published",
                "Bourgoyne, Millheim, Chenevert, Young, Applied Drilling Engineering (SPE textbook), as carried by "
                "public "
                "validation suites", "",
                "12 lb/gal, 400 gal/min, three nozzles of 12/32 in, discharge coefficient 0.95", "nothing",
                rows)


def annulus_loss(hole, pipe, density, flow, **mud):
    """[psi] over 1000 ft of annulus; diameters [in], density [lb/gal], flow [gal/min]."""
    with mbd.Model() as model:
        model.add_wall(diameter=hole * INCH, direction=(0.0, 0.0, -1.0))
        model.set_environment(fluid_density=density * POUND_GALLON, flow_rate=flow * GALLON_MINUTE, nozzle_area=1e-3,
                              **mud)
        model.add_pipes(10, length=100.0 * FOOT, outer_diameter=pipe * INCH, inner_diameter=0.8 * pipe * INCH)
        model.add_bit(mass=1.0, diameter=0.0)
        model.compile()
        with model.sim() as sim:
            return sim.flow().annulus_loss / PSI


@case("annulus")
def annulus(pictures):
    slurry = annulus_loss(8.097, 4.5, 15.0, 200.0, consistency=9.4, flow_exponent=0.3)
    thin = annulus_loss(7.0, 5.0, 9.0, 80.0, consistency=0.015)
    rows = [Row("power law, n 0.3, K 9400 eq. cP, 8.097 x 4.5 in, 200 gal/min", "psi/1000 ft", 77.9, slurry, "", 0.005),
            Row("Newtonian, 15 cP, 7 x 5 in, 80 gal/min, over 10 000 ft", "psi", 51.09, 10.0 * thin, "", 0.005)]
    return Case("annulus", "Laminar pressure loss of annuli", "published",
                "Bourgoyne, Millheim, Chenevert, Young, Applied Drilling Engineering (SPE textbook), worked examples "
                "with the slot "
                "flow approximation", "", "diameters, flow and mud as in the rows", "nothing", rows,
                "The textbook's constants are rounded to three or four digits.")


#: Outer and inner diameter [in] of drill pipe E75, tensile [lbf] and torsional [ft lbf] yield of new pipe.
PIPES = ((3.5, 2.764, 271569.0, 18551.0), (4.0, 3.34, 285359.0, 23288.0), (4.5, 3.826, 330558.0, 30807.0),
         (5.0, 4.276, 395595.0, 41167.0), (5.5, 4.778, 437116.0, 50710.0))


def yield_share(outer, inner, pull, torque):
    """[-] largest von Mises stress over 75 000 psi of a pipe under a pull [lbf] and a torque [ft lbf]."""
    with mbd.Model() as model:
        model.set_environment(gravity=(0.0, 0.0, 0.0))
        string = model.add_string(follows_hole=0, start_free=mbd.FREE_NONE)
        model.add_pipes(1, string=string, length=9.0, outer_diameter=outer * INCH, inner_diameter=inner * INCH,
                        yield_strength=75e3 * PSI)
        model.add_load(place=mbd.station(string, 0, 1.0), force=(pull * POUND, 0.0, 0.0),
                       moment=(torque * POUND * FOOT, 0.0, 0.0),
                       time_function=model.add_time_function(1.0))
        model.compile()
        with model.sim() as sim:
            sim.static()
            return float(max(sim.profile(string)["yield_share"]))


def pinned_speed(outer, inner, length, elements=8):
    """[rev/min] first lateral natural frequency of a pipe with pinned ends."""
    with mbd.Model() as model:
        model.set_environment(gravity=(0.0, 0.0, 0.0))
        string = model.add_string(follows_hole=0, start_free=mbd.FREE_SPHERICAL, end_free=mbd.FREE_SPHERICAL)
        model.add_pipes(1, string=string, length=length, elements=elements, outer_diameter=outer * INCH,
                        inner_diameter=inner * INCH, young_modulus=30e6 * PSI, density=0.2833 * 0.45359237 / INCH ** 3)
        model.compile()
        with model.sim() as sim:
            modes = sim.modes(count=8)
            return 60.0 * min(modes[k].frequency for k in range(modes.info.count) if modes[k].share[2] > 0.5)


@case("pipe_tables")
def pipe_tables(pictures):
    rows, length = [], 360.0
    for outer, inner, pull, torque in PIPES:
        rows += [Row(f"{outer:g} in: pull {pull:.0f} lbf, share of the yield strength", "-", 1.0,
                     yield_share(outer, inner, pull, 0.0), "", 1e-3),
                 Row(f"{outer:g} in: torque {torque:.0f} ft lbf, share of the yield strength", "-", 1.0,
                     yield_share(outer, inner, 0.0, torque), "", 1e-3),
                 Row(f"{outer:g} in: critical speed of 30 ft, 4.76e6/l² √(D² + d²)", "rev/min",
                     4.76e6 / length ** 2 * math.sqrt(outer ** 2 + inner ** 2),
                     pinned_speed(outer, inner, length * INCH),
                     "8 elements", 2e-3)]
    return Case("pipe_tables", "Drill pipe E75: tensile and torsional yield, critical speed", "published",
                "API RP 7G, drill stem design and operating limits: tensile and torsional data of new drill pipe; "
                "critical rotary "
                "speeds by its formula", "",
                "outer and inner diameter, 75 000 psi, steel of 30e6 psi and 0.2833 lb/in³", "nothing", rows,
                "The table takes 0.577 for 1/√3: 6e-4 in torsion. The constant of its critical speeds is rounded "
                "(4.764e6 by the "
                "steel given); shear and rotary inertia, which it leaves out, lower the larger pipes' by up to 0.1 %.")
