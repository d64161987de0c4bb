"""A very flexible wing under a mass at its tip: bending and torsion measured by others. Blind: the scene and the rule were
committed before the measured figures were read."""
import math

import numpy as np

import drillmbd as mbd
from case import Case, Row, case, picture

SEMISPAN, CHORD, AXIS = 0.55, 0.0989, 0.441  #: [m, m, -] the axis lies at this part of the chord behind the leading edge
NODES = (0.0, .038249998, .076499998, .114749997, .152999996, .191249995, .229499995, .267749994, .305999993, .344249993,
         .382499992, .420749991, .45899999, .49724999, .530718683, .549843728)  # [m]
#: Torsion, bending out of plane, bending in plane [N m2] of 15 elements and masses [kg] of 16 nodes, without and with skin.
SECTIONS = {
    "without skin": (
        (7.2801,) * 4 + (6.4468,) * 4 + (6.4508,) * 4 + (7.0484,) * 2 + (17.161,),
        (4.5919, 4.4474, 4.4276, 4.4243, 4.4246, 4.4246, 4.4246, 4.4246, 4.4246, 4.4246, 4.4244, 4.4258, 4.4387, 4.4985,
         4.7103),
        (3318.2, 3274.5, 3279.6, 3283.8, 3286.7, 3288.4, 3289.2, 3289.4, 3288.8, 3287.4, 3285.0, 3281.3, 3276.3, 3268.3,
         3371.1),
        (.015953, .020679) + (.020683,) * 12 + (.025448, .037056)),
    "with skin": (
        (7.5826,) * 4 + (6.5118,) * 4 + (6.5158,) * 4 + (7.1189,) * 2 + (17.373,),
        (5.2474, 4.5045, 4.4782, 4.4744, 4.4748, 4.4749, 4.4749, 4.4749, 4.4749, 4.4749, 4.4747, 4.4762, 4.4892, 4.5482,
         4.7704),
        (3317.6, 3278.6, 3282.9, 3286.5, 3288.8, 3290.1, 3290.7, 3290.7, 3290.2, 3288.9, 3286.9, 3283.5, 3279.0, 3271.6,
         3373.7),
        (.019119, .020679) + (.020683,) * 12 + (.025448, .043156))}
STRETCH, SHEAR = 9.65e6, 1e7  # [N] the published model has no shear: a stiffness that lets it show below 1e-6
#: [m] places of the mass behind the axis: in the middle of the chord, or behind the trailing edge.
MIDDLE = (0.5 - AXIS) * CHORD
BEHIND = {"without skin": (1.0 - AXIS) * CHORD + 0.04, "with skin": (1.0 - AXIS) * CHORD + 0.08}


def masses_of(nodes):
    """Mass of each element: half of those of its nodes, all of the first and of the last one's."""
    half = [0.5 * mass for mass in nodes]
    half[0], half[-1] = nodes[0], nodes[-1]
    return [half[k] + half[k + 1] for k in range(len(nodes) - 1)]


def hanging(wing, mass, behind):
    """Height [m] of the tip in the middle of its chord and twist [rad], with a mass at the tip behind the axis."""
    torsion, bending, edgewise, nodes = SECTIONS[wing]
    with mbd.Model() as model:
        string = model.add_string(follows_hole=0, start_free=0)
        for k, own in enumerate(masses_of(nodes)):
            length = NODES[k + 1] - NODES[k]
            model.add_pipes(1, string=string, length=length, elements=2, outer_diameter=0.02, inner_diameter=0.0,
                            section_stiffness=(STRETCH, SHEAR, SHEAR, torsion[k], bending[k], edgewise[k]),
                            section_mass=own / length, section_inertia=(2e-4, 1e-4))
        if mass:
            model.add_body(attach=mbd.ATTACH_END, string=string, mass=mass, centre=(0.0, -behind, 0.0),
                           inertia=(1e-6, 1e-6, 1e-6, 0.0, 0.0, 0.0))
        model.compile()
        with model.sim() as sim:
            sim.static()
            tip = mbd.station(string, len(NODES) - 2, 1.0)
            heights = [sim.pose_at(tip, (0.0, y, 0.0)).position[2] for y in (-MIDDLE, AXIS * CHORD, -(1.0 - AXIS) * CHORD)]
            return heights[0], math.asin((heights[1] - heights[2]) / CHORD)


def change(wing, mass, behind):
    """Vertical displacement [% of the semispan] and twist [degrees] that the mass adds to those under the own weight."""
    empty, loaded = hanging(wing, 0.0, 0.0), hanging(wing, mass, behind)
    return 100.0 * (loaded[0] - empty[0]) / SEMISPAN, math.degrees(loaded[1] - empty[1])


#: Errors that are accepted: of the vertical displacement, of the twist.
DISPLACEMENT_BOUND, TWIST_BOUND = 0.05, 0.10
