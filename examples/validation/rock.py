"""The rig of the reference study with a rock law at its bit, beside the force that the study has in its place."""
import pathlib

import numpy

from case import Case, Row, case, picture
from drillmbd import scene

SCENE = pathlib.Path(__file__).resolve().parents[1] / "scenes" / "reference_rig.toml"
LOAD, FEED, SPEED, RADIUS, RATIO = 2960.0, 0.01, 200.0 / 60.0, 0.047, 0.6  # [N, m/s, 1/s, m, -]
#: [Pa] so that W = zeta eps a V/n is the load
ENERGY = LOAD * SPEED / (RATIO * RADIUS * FEED)
END, FIRST, STEP, LOOK = 10.0, 5.0, 1e-3, 10                                # [s, s, s, steps]
ROCK = {"bit.rock_law": "regenerative", "bit.intrinsic_energy": f"{ENERGY} Pa", "bit.wear_length": "0 m",
        "time_function[bottom load].segment": [{"kind": "constant", "h0": "0 N"}]}


def run(changes):
    """Rows of time, of the outputs - heights of bit and of the end of pipe 50 [m], torque [N m] and push [N] at the rig
    - and of 1 on the rock, 0 off it."""
    found, rows = scene.load(SCENE, changes), []
    with found.new_sim() as sim:
        sim.static(**found.fields_of("static"))
        while sim.time < END - 1e-9:
            sim.steps(STEP, LOOK)
            rows.append([sim.time, *(sim.output(quantity, place) for _, place, quantity in found.outputs),
                         sim.bit(found.names["bit"]).on_bottom])
    return numpy.array(rows)


@case("rock")
def rock(pictures):
    force, law = run({}), run(ROCK)
    late = force[:, 0] > FIRST
    mean, spread = ([part[late, 1:].mean(axis=0) for part in (force, law)],
                    [part[late, 1:].std(axis=0) for part in (force, law)])
    used = f"100 elements, {1e3 * STEP:g} ms, from {FIRST:g} to {END:g} s"
    rows = [Row("mean height of the bit", "mm", 1e3 * mean[0][0], 1e3 * mean[1][0], used, 0.02),
            Row("mean height of pipe 50", "mm", 1e3 * mean[0][1], 1e3 * mean[1][1], used, 0.02),
            Row("standard deviation of the bit's height", "mm", 1e3 * spread[0][0], 1e3 * spread[1][0], used),
            Row("mean torque at the rig", "N m", mean[0][2], mean[1][2], used),
            Row("standard deviation of the torque", "N m", spread[0][2], spread[1][2], used),
            Row("mean push at the rig", "N", mean[0][3], mean[1][3], used),
            Row("standard deviation of the push", "N", spread[0][3], spread[1][3], used),
            Row("part of the time with the bit off the rock", "-", 0.0, 1.0 - mean[1][4], used, scale=1.0)]

    def draw(axes):
        for place, column, label in zip(axes, (1, 3), ("height of the bit [mm]", "torque at the rig [N m]")):
            for part, name, color in ((law, "regenerative law", "C1"), (force, "force of 2.96 kN", "C0")):
                place.plot(part[:, 0], part[:, column] * (1e3 if column == 1 else 1.0), color=color, linewidth=0.6,
                           label=name)
            place.set(xlabel="time [s]", ylabel=label)
        axes[0].legend()
    return Case("rock", "The reference study with a rock law at the bit", "published",
                "the scene of the reference study, whose pressure at the bottom of the hole is read as a force of 2.96 "
                "kN; regenerative law of Richard, Germay, Detournay 2007",
                "10.1016/j.jsv.2007.04.015",
                "the rig in its hole at 10 mm/s and 200 rev/min; reference: the force of 2.96 kN; computed: rock of "
                f"{ENERGY / 1e6:.3g} MPa, which bears as much in "
                "steady drilling, cut by 4 blades of 47 mm without wear flats", "nothing", rows,
                "Not a figure of the study, which has no law at the bit. Bit and pipe lie where they do under the "
                "force. Axial self-excited vibration of the string, whose "
                "material damping is small, throws the bit off the rock and drives torque and push; their spread is "
                "many times that under the force. Mean heights "
                "change by less than 1 %.",
                pictures=[picture(draw, columns=2)] if pictures else [])
