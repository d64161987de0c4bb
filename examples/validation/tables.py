"""Losses of flow: textbook examples."""
import math

import drillmbd as mbd
from case import Case, Row, case

PSI, GALLON_MINUTE, POUND_GALLON, INCH = 6894.757, 0.0037854118 / 60.0, 119.826427, 0.0254


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
                "Bourgoyne, Millheim, Chenevert, Young, Applied Drilling Engineering (SPE textbook), as carried by public "
                "validation suites", "", "12 lb/gal, 400 gal/min, three nozzles of 12/32 in, discharge coefficient 0.95", "nothing",
                rows)
