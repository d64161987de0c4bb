"""A very flexible wing under a mass at its tip: bending and torsion measured by others. Blind: the scene and the rule
were committed before the measured figures were read."""
import math

import numpy as np

import drillmbd as mbd
from case import Case, Row, case, picture

#: [m, m, -] the axis lies at this part of the chord behind the leading edge
SEMISPAN, CHORD, AXIS = 0.55, 0.0989, 0.441
NODES = (0.0, .038249998, .076499998, .114749997, .152999996, .191249995, .229499995, .267749994, .305999993,
         .344249993,
         .382499992, .420749991, .45899999, .49724999, .530718683, .549843728)  # [m]
#: Torsion, bending out of plane, bending in plane [N m2] of 15 elements and masses [kg] of 16 nodes, without and with
#: skin.
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
        string = model.add_string(follows_hole=0, start_free=mbd.FREE_NONE)
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
            heights = [sim.pose_at(tip, (0.0, y, 0.0)).position[2]
                       for y in (-MIDDLE, AXIS * CHORD, -(1.0 - AXIS) * CHORD)]
            return heights[0], math.asin((heights[1] - heights[2]) / CHORD)


#: Inertia [kg m2] of the last node about the span and about both axes across it, and its centre of mass behind the axis
#: [m]; of the others about the span, per node.
TIP = {"without skin": (1.222e-4, 1.226e-4, 0.004876), "with skin": (1.222e-4, 1.2261e-4, 0.0050927)}
ABOUT_SPAN = 1.0979e-5


def frequencies(wing, count=5):
    """[Hz] of the bare wing, and for each mode the kind of motion: bending, edgewise or torsion."""
    torsion, bending, edgewise, nodes = SECTIONS[wing]
    with mbd.Model() as model:
        model.set_environment(gravity=(0.0, 0.0, 0.0))
        string = model.add_string(follows_hole=0, start_free=mbd.FREE_NONE)
        shares = masses_of((*nodes[:-1], 0.0))
        for k, own in enumerate(shares):
            length = NODES[k + 1] - NODES[k]
            model.add_pipes(1, string=string, length=length, elements=2, outer_diameter=0.02, inner_diameter=0.0,
                            section_stiffness=(STRETCH, SHEAR, SHEAR, torsion[k], bending[k], edgewise[k]),
                            section_mass=own / length,
                            section_inertia=(ABOUT_SPAN / 0.03825, 0.5 * ABOUT_SPAN / 0.03825))
        span, across, behind = TIP[wing]
        model.add_body(attach=mbd.ATTACH_END, string=string, mass=nodes[-1], centre=(0.0, -behind, 0.0),
                       inertia=(span, 1e-6, across, 0.0, 0.0, 0.0))
        model.compile()
        with model.sim() as sim:
            found, modes = [], sim.modes(count=count)
            for k in range(count):
                shape = modes.shape(k, mbd.station(string, len(NODES) - 2, 1.0)).re
                size = {"bending": abs(shape[2]), "edgewise": abs(shape[1]), "torsion": CHORD * abs(shape[3])}
                found.append((modes[k].frequency, max(size, key=size.get)))
            return found


def change(wing, mass, behind):
    """Vertical displacement [% of the semispan] and twist [degrees] that the mass adds to those under the own
    weight."""
    empty, loaded = hanging(wing, 0.0, 0.0), hanging(wing, mass, behind)
    return 100.0 * (loaded[0] - empty[0]) / SEMISPAN, math.degrees(loaded[1] - empty[1])


#: Errors that are accepted: of the vertical displacement, of the twist.
DISPLACEMENT_BOUND, TWIST_BOUND = 0.05, 0.10
FREQUENCY_BOUND = 0.05  #: of natural frequencies of the bare wing with skin: two bendings and the first torsion
COMMIT = "343a141e"
#: Mass [kg]: measured vertical displacement [% of the semispan]; of torsion also the twist [degrees], nose up.
BENDING = {"without skin": {0.6: -13.549304, 1.0: -22.097188, 1.4: -29.553852, 2.0: -38.829214},
           "with skin": {0.6: -12.487366, 1.0: -21.151525, 2.0: -37.733691, 3.0: -50.086959}}
TORSION = {"without skin": {0.6: (-14.003979, 2.412454), 1.0: (-22.460927, 4.221794), 2.0: (-38.920149, 6.031135)},
           "with skin": {0.6: (-13.974213, 2.995113), 1.0: (-22.164783, 4.835643), 2.0: (-38.208674, 8.005643),
                         2.8: (-47.001536, 9.218521)}}
#: The same of the published beam model, by its own program: bending displacement, twist in torsion.
PROGRAM = {"without skin": {1.0: (-20.640587, 3.810188), 2.0: (-36.395362, 6.461939), 3.0: (-47.292806, 8.038420)},
           "with skin": {1.0: (-20.009503, 5.389196), 2.0: (-35.444084, 9.170990), 3.0: (-46.244362, 11.458614)}}


def measured_rows():
    """Against the tests, nothing fitted."""
    rows = []
    for wing, points in BENDING.items():
        for mass, want in points.items():
            rows.append(Row(f"bending {wing}, {mass:g} kg: displacement, measured", "% of semispan", want,
                            change(wing, mass, MIDDLE)[0], "30 elements, blind", DISPLACEMENT_BOUND))
    for wing, points in TORSION.items():
        for mass, (down, twist) in points.items():
            got = change(wing, mass, BEHIND[wing])
            rows += [Row(f"torsion {wing}, {mass:g} kg: displacement, measured", "% of semispan", down, got[0],
                         "30 elements, blind", DISPLACEMENT_BOUND),
                     Row(f"torsion {wing}, {mass:g} kg: twist, measured", "degrees", twist, got[1],
                         "30 elements, blind",
                         TWIST_BOUND)]
    return rows


def program_rows():
    """Against the published beam model in its own program."""
    rows = []
    for wing, points in PROGRAM.items():
        for mass, (down, twist) in points.items():
            rows += [Row(f"bending {wing}, {mass:g} kg: displacement, published beam model", "% of semispan", down,
                         change(wing, mass, MIDDLE)[0], "30 elements", 0.005),
                     Row(f"torsion {wing}, {mass:g} kg: twist, published beam model", "degrees", twist,
                         change(wing, mass, BEHIND[wing])[1], "30 elements", 0.04)]
    return rows


@case("wing")
def tip_mass(pictures):
    """The case."""
    def draw(axes):
        masses = np.linspace(0.2, 3.0, 8)
        for color, wing in zip(("C0", "C1"), SECTIONS):
            axes[0].plot(masses, [change(wing, mass, MIDDLE)[0] for mass in masses], color=color,
                         label=f"{wing}, computed")
            axes[0].plot(list(BENDING[wing]), list(BENDING[wing].values()), "o", color=color, label=f"{wing}, measured")
            axes[1].plot(masses, [change(wing, mass, BEHIND[wing])[1] for mass in masses], color=color)
            axes[1].plot(list(TORSION[wing]), [twist for _, twist in TORSION[wing].values()], "o", color=color)
        axes[0].set(xlabel="mass at the tip [kg]", ylabel="displacement [% of semispan]",
                    title="bending: mass in the middle")
        axes[1].set(xlabel="mass at the tip [kg]", ylabel="twist [degrees]",
                    title="torsion: mass behind the trailing edge")
        axes[0].legend()
    return Case("wing", "Very flexible wing under a mass at its tip: bending and torsion", "measured",
                "tests: Avin, Raveh, Drachinsky, Ben-Shmuel, Tur 2022, AIAA Journal 60; digits and the beam model by "
                "way "
                "of the public repository UM-A2SRL/AePW3-LDWG (Riso, Cesnik 2023, J. Aircraft)", "10.2514/1.J060621",
                "stiffness of 15 elements and masses of 16 nodes of the published beam model; couplings of bending, "
                "torsion "
                "and stretch left out; mass in the middle of the tip's chord, or 40 and 80 mm behind the trailing edge",
                "nothing", measured_rows() + program_rows(),
                f"Blind: scene, quantities and accepted errors were committed as {COMMIT} before the measured figures "
                "were "
                "read. The prediction misses: the wing bends by up to 11 % more than computed and, with skin, twists "
                "by 13 to 22 % less. "
                "Looked at: the published beam model in its own program gives the same displacements within 0.2 % "
                "(twist "
                "within 3 %, as couplings are left out), so that it is the stiffness of that model that differs from "
                "the wing.",
                "figures as published; the repository states no licence, so that only the points used stand in wing.py",
                [picture(draw, 2, 8.5, 3.4)] if pictures else [])
#: Measured natural frequencies [Hz] of the bare wing with skin, and those of the published beam model by its own
#: program.
GROUND_TEST = (("first bending", 4.26), ("second bending", 28.5), ("first torsion", 42.0), ("third bending", 81.5),
               ("first edgewise bending", 60.7))
PROGRAM_MODES = (4.1906, 28.493, 41.879, 83.065, 105.89)
MODES_COMMIT, ASKED = "d64773ae", 3


@case("wing_modes")
def natural_frequencies(pictures):
    """The case."""
    found, rows = frequencies("with skin"), []
    for k, ((name, measured), published) in enumerate(zip(GROUND_TEST, PROGRAM_MODES)):
        computed = found[k][0]
        rows += [Row(f"{name}, measured", "Hz", measured, computed, "30 elements, blind" if k < ASKED
                     else "30 elements",
                     FREQUENCY_BOUND),
                 Row(f"{name}, published beam model", "Hz", published, computed, "30 elements", 0.05)]
    def draw(axes):
        places = np.arange(len(GROUND_TEST))
        axes.bar(places - 0.2, [one for _, one in GROUND_TEST], 0.4, color="C3", label="measured")
        axes.bar(places + 0.2, [one for one, _ in found], 0.4, color="C0", label="computed")
        axes.set_xticks(places, [name.replace(" bending", "\nbending") for name, _ in GROUND_TEST])
        axes.set(ylabel="natural frequency [Hz]", yscale="log")
        axes.legend()
    return Case("wing_modes", "The same wing: natural frequencies", "measured",
                "ground vibration test of Avin, Raveh, Drachinsky, Ben-Shmuel, Tur 2022, AIAA Journal 60; digits and "
                "the beam "
                "model by way of the public repository UM-A2SRL/AePW3-LDWG", "10.2514/1.J060621",
                "stiffness, mass and rotary inertia of the published beam model; couplings and offsets of the mass "
                "left out but "
                "at the tip", "nothing", rows,
                "Blind: scene and rule (two bendings and the first torsion within 5 %) were committed as "
                f"{MODES_COMMIT} before "
                "the measured figures were read, and are met. The other two modes were not in the rule. Edgewise "
                "misses: it is measured at 60.7 Hz, where the "
                "published model gives 106 Hz and this one 111 Hz; the reason is not known here.",
                "figures as published", [picture(draw)] if pictures else [])
