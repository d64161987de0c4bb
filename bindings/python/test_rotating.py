"""Tests of rotating strings: the linear state of response and speeds against a run in time, critical speeds over a
range and in time, and the friction table of the wall.
Equations: eq:sliding.state."""
import csv
import dataclasses
import math
import re
import unittest
import unittest.mock
from pathlib import Path

from shared_tests import DRIVES, FolderTest, needs

needs("numpy")

import numpy  # noqa: E402

import drillmbd as mbd  # noqa: E402
from drillmbd import (critical_speeds, live_scene, no_response, report_basis, report_linear, rig_torque, rotating,
                      scene as scenes, speed_check, speed_range)  # noqa: E402
from drillmbd import station  # noqa: E402
from drillmbd.operating import operating  # noqa: E402
from drillmbd.scene import words  # noqa: E402
from drillmbd.unit_systems import SI  # noqa: E402
from drillmbd.verdict import Demand, Tile  # noqa: E402

EXAMPLES = Path(__file__).resolve().parents[2] / "examples" / "scenes"
SCENE = """title = "level hole"
[hole]
diameter = "94 mm"
mu_static = 0.30
mu_dynamic = 0.30
[[time_function]]
name = "turning"
segment = {kind = "step5", x1 = "1 s", h1 = "100 rpm"}
[[string]]
name = "main"
[[string.pipes]]
count = 12
length = "1.5 m"
outer_diameter = "73 mm"
inner_diameter = "59 mm"
eccentricity = "0.5 mm"
[[bit]]
name = "bit"
mass = "6 kg"
diameter = "94 mm"
load = "0 kN"
""" + DRIVES + """[run]
step = "1 ms"
end = "6 s"
[response]
frequency_low = "1 Hz"
frequency_high = "4 Hz"
points = 31
[[response.excitation]]
kind = "eccentricity"
[[response.output]]
name = "middle"
place = {part = "main", pipe = 6}
quantity = "vibration-y"
[speeds]
speed_low = "60 rpm"
speed_high = "240 rpm"
points = 31
refinement = 0
threshold = 100
[[speeds.order]]
[[speeds.output]]
name = "middle"
place = {part = "main", pipe = 6}
quantity = "vibration-y"
limit = "1 um"
"""
SHAKEN = """[[time_function]]
name = "shaking"
segment = {kind = "harmonic", h1 = 1, omega = "20 rad/s"}
[[load]]
place = {part = "main", pipe = "last", fraction = 1.0}
moment = ["20 N m", 0, 0]
time_function = "shaking"
"""
RANGE = """[variability]
question = "static"
[[variability.scatter]]
name = "friction"
keys = ["hole.mu_dynamic", "hole.mu_static"]
distribution = "uniform"
low = 0.2
high = 0.4
[[variability.scatter]]
name = "diameter"
key = "hole.diameter"
distribution = "uniform"
low = "94 mm"
high = "104 mm"
"""


class SpeedsTest(FolderTest):
    """The report of the scene of a test."""

    def assert_no_verdict(self):
        """The tile of the report gives no all-clear."""
        scene = scenes.load(self.scene)
        self.assertEqual(report_linear.speeds_tile(report_linear.speeds(scene, print), operating(scene)).verdict,
                         "NOT ASSESSED")


class LinearStateTest(SpeedsTest):
    """One linear state for response and speeds."""
    SCENE = SCENE

    def test_amplitudes_at_tool_joints(self):
        """Tool joints of 90 mm leave 2 mm of the hole's 94 mm, pipes of 73 mm leave 10.5 mm."""
        scene = scenes.loads(SCENE.replace('eccentricity = "0.5 mm"',
                                           'joint_length = "0.3 m"\njoint_outer_diameter = "90 mm"'))
        for pipe, fraction, clearance in ((0, 0.0, 10.5e-3), (6, 0.5, 10.5e-3), (6, 0.79, 10.5e-3), (6, 0.81, 2e-3),
                                          (6, 1.0, 2e-3), (7, 0.0, 2e-3)):
            place = station(scene.names["main"], pipe, fraction)
            found = critical_speeds.clearance_at(scene, place)
            self.assertAlmostEqual(found, clearance, delta=1e-12, msg=f"pipe {pipe}, {fraction}")
            output = mbd.Output(quantity=mbd.enums.OUTPUT_VIBRATION + mbd.enums.Y, place=place)
            self.assertEqual("touches the wall" in critical_speeds.touches(scene, output, 5e-3), clearance < 5e-3)

    def test_what_the_analysis_leaves_out(self):
        """Pipes that are not round: response and speeds neglect what changes as they turn, so that no speed is free;
        modes that are not found are missing."""
        A, I, E = math.pi / 4.0 * (0.073 ** 2 - 0.059 ** 2), math.pi / 64.0 * (0.073 ** 4 - 0.059 ** 4), 2.1e11
        for softer, whole in ((1.0, True), (0.7, False)):
            stiffness = [f"{one} N" for one in (E * A, 0.2 * E * A, 0.2 * E * A)] + [
                f"{one} N m^2" for one in (0.77 * E * I, E * I, softer * E * I)]
            self.scene = self.write("flat.toml", SCENE.replace(
                'eccentricity = "0.5 mm"', f'eccentricity = "0.5 mm"\nsection_stiffness = {stiffness}')
                .replace("threshold = 100", "threshold = 1e6"))
            out, summary = self.results("speeds")
            self.assertEqual(("no critical speed between" in out, summary["speeds_assessed"]), (whole, whole), out)
            self.assertEqual("the rotor must be round" in " ".join(summary["notes"]), not whole)
            self.assertEqual("the rotor must be round" in self.results("response")[0], not whole)
        self.assert_no_verdict()
        self.scene = self.write("thick.toml", SCENE.replace('eccentricity = "0.5 mm"', 'damping_time = "1 s"')
                                + '[modes]\nkind = "damped"\n')
        self.assertNotIn("was not found", self.results("modes", "--count", "10")[0])
        self.assertIn("was not found sharply", self.results("modes", "--count", "40")[0])

    def test_more_bands_than_room(self):
        """A speed in a band that is left out would be free."""
        real = mbd.Sim.speeds

        def speeds(sim, *given, room=1, **options):
            return real(sim, *given, room=room, **options)
        scene = scenes.load(self.scene, {"speeds.threshold": 1000, "speeds.margin": 0,
                                         "speeds.order": [{}, {"order": 2}]})
        with unittest.mock.patch.object(mbd.Sim, "speeds", speeds):
            found = critical_speeds.analyse(scene, lambda sim, state: sim.static(**state.static), self.fail)
        self.assertGreater(len(found.bands), 1)
        self.assertEqual(len(found.bands), found.bands.report.bands)

    def test_response_and_speeds_agree(self):
        """The amplitude of one quantity at one frequency is the same number in both."""
        for change in ({}, {"time_function[0].segment.h1": "170 rpm"}, {"bit[0].load": "5 kN"}):
            scene = scenes.load(self.scene, change)
            _, response = rotating.linear(
                scene, "response", lambda sim, state: sim.static(**state.static),
                lambda sim, state: sim.response(state.scene.excitations(), state.scene.response_outputs("response"),
                                                **state.options), self.fail)
            state, (bands, severity) = rotating.linear(
                scene, "speeds", lambda sim, state: sim.static(**state.static),
                lambda sim, state: sim.speeds(state.scene.orders(), state.scene.response_outputs("speeds"), [1e-6],
                                              **state.options), self.fail)
            numpy.testing.assert_allclose(numpy.array(severity) * 1e-6, abs(response.transfer(output=0)), rtol=1e-9)
            self.assertGreater(state.rotation, 10.0)

    def test_a_run_in_time_swings_as_much(self):
        """At 100 rpm, far below the resonance, the harmonic of the turning in a run is that of the linear state, 0.967
        of it across and upwards.
        At rest without friction the string lies in the middle of the bottom and moves upwards a hundred times less; at
        rest with friction the wall holds it, and it moves across half as much. Drag damps the start away."""
        scene = scenes.load(self.write("drag.toml",
                                       SCENE.replace("[hole]", '[environment]\nlateral_damping = "60 N s/m2"\n[hole]',
                                                     1)))
        speed, place = 100.0 * rotating.RPM, station(scene.names["main"], 6)
        outputs = [(place, "vibration_y"), (place, "vibration_z")]
        state = rotating.sliding(scene, "response")
        sliding_options = {key: state.options[key] for key in ("spin", "friction", "axes", "equilibrium_tolerance")}

        def linear(static, **options):
            with scene.new_sim() as sim:
                sim.static(**static)
                found = sim.response(scene.excitations(), outputs, frequencies=[speed / (2.0 * math.pi)], **options)
                return numpy.array([abs(found.transfer(output=k)[0]) for k in range(2)])

        sliding, rest, held = linear(state.static, **sliding_options), linear({}, friction=0, axes=1), linear({})
        with scene.new_sim() as sim:
            sim.static()
            sim.run(3.0, 1e-3)
            times, points = [], []
            while sim.time < 4.8 - 1e-9:  # three revolutions
                sim.step(1e-3)
                times.append(sim.time)
                points.append(sim.pose(place).position[1:3])
        t, x = numpy.array(times), numpy.array(points)
        columns = numpy.stack([numpy.ones_like(t), t, numpy.cos(speed * t), numpy.sin(speed * t)], axis=1)
        fit = numpy.linalg.lstsq(columns, x, rcond=None)[0]
        run = numpy.hypot(fit[2], fit[3])
        numpy.testing.assert_allclose(sliding, run, rtol=0.05)
        self.assertLess(rest[1], 0.1 * run[1])
        self.assertLess(held[0], 0.7 * run[0])

    def test_state_is_said(self):
        for command in ("response", "speeds"):
            out = self.call(command, self.scene)
            self.assertIn("linear about the string that slides on the wall at 100 rpm", out)
        still = self.write("still.toml", SCENE.replace('h1 = "100 rpm"', 'h1 = "0 rpm"'))
        self.assertNotIn("slides", self.call("response", still))
        self.assertIn("slides on the wall at 150 rpm", self.call("speeds", still))  # the middle of the range

    def test_saved_state(self):
        """A saved scene has the state, and gives the same."""
        for command in ("response", "speeds"):
            first = self.call(command, self.scene)
            self.call("save", self.scene, self.folder / "copy.toml")
            self.assertEqual(self.call(command, self.folder / "copy.toml"), first)
        self.assertIn("spin = ", (self.folder / "copy.toml").read_text(encoding="utf-8"))

    def test_a_refused_state_is_replaced(self):
        """Where the sliding state has no solution both take the state at rest, and say so."""
        notes = []

        def settle(sim, state):
            if state.rotation:
                raise mbd.Error(mbd.ERR_NO_CONVERGENCE, "no solution")
            sim.static(**state.static)

        state, _ = rotating.linear(scenes.load(self.scene), "speeds", settle, lambda sim, state: None, notes.append)
        self.assertEqual((state.rotation, state.options["friction"], state.refused), (0.0, 0, True))
        self.assertIn("no solution", notes[0])

    def test_a_rotation_outside_the_range_is_noted(self):
        """The scene turns at 100 rpm; ends of the range are in it."""
        for low, high, noted in ((60, 240, False), (100, 240, False), (60, 100, False), (110, 240, True),
                                 (60, 90, True)):
            self.scene = self.write("range.toml", SCENE.replace('"60 rpm"', f'"{low} rpm"').replace('"240 rpm"',
                                                                                                  f'"{high} rpm"'))
            self.assertEqual("100 rpm is outside the range of [speeds]" in self.call("speeds", self.scene), noted,
                             (low, high))

    def test_a_refused_state_is_no_all_clear(self):
        """The command, its range and the report say not assessed where the sliding state has no solution and no band
        was found."""
        self.scene = self.write("high.toml", SCENE.replace("threshold = 100", "threshold = 1e6") + RANGE)
        self.assertIn("no critical speed between", self.call("speeds", self.scene))
        static = mbd.Sim.static

        def refusing(sim, *arguments, **fields):
            if fields.get("slip_rotation"):
                raise mbd.Error(mbd.ERR_NO_CONVERGENCE, "no solution")
            return static(sim, *arguments, **fields)

        with unittest.mock.patch.object(mbd.Sim, "static", refusing):
            out, summary = self.results("speeds")
            self.assertIn("speeds of the string that turns: not assessed", out)
            self.assertIn("(4 cases, all combinations): not assessed", out)
            self.assertNotIn("no critical speed", out)
            self.assertFalse(summary["speeds_assessed"])
            self.assert_no_verdict()


class PerRevolutionTest(FolderTest):
    """A head whose own time function oscillates with its revolutions: 100 rpm and 5 % of it."""
    SCENE = SCENE.replace('segment = {kind = "step5", x1 = "1 s", h1 = "100 rpm"}',
                          """segment = {kind = "step5", x1 = "1 s", h1 = "100 rpm"}
[[time_function]]
name = "worn"
segment = [{kind = "step5", x1 = "1 s", h1 = "100 rpm"},
           {kind = "per-revolution", of = "turning", h1 = "2 rpm", share = "-5 %"}]""").replace(
        'time_function = "turning"', 'time_function = "worn"')

    def test_operation(self):
        """The rotation counts with its amplitude, as that of a harmonic does, in every place that reads it."""
        scene, most = scenes.load(self.scene), 107.0 * rotating.RPM
        self.assertAlmostEqual(operating(scene).rotation, most, 12)
        self.assertAlmostEqual(rotating.options_of(scene, "speeds")["spin"], most, 12)
        self.assertEqual(str(words.describe(scene, 0.0)[-2]), "feed 0 mm/s, rotation 107 rpm")
        live = live_scene.with_inputs(scene)
        slider = next(arguments[0] for name, arguments in live if name == "add_input"
                      and arguments[0]["name"] == "rotation")
        self.assertAlmostEqual(slider["high"], 2.0 * most, 12)

    def test_a_share_of_no_rotation(self):
        text = self.SCENE.replace("100 rpm", "0 rpm").replace('h1 = "2 rpm"', 'h1 = "0 rpm"')
        scene = scenes.load(self.write("still.toml", text))
        self.assertEqual(operating(scene).rotation, 0.0)
        self.assertIn("no rotation", str(words.trivial(scene)[0]))
        self.assertFalse(any("no rotation" in str(one) for one in words.trivial(scenes.load(self.scene))))

    def test_check_names_the_oscillation_that_it_leaves_out(self):
        scene = scenes.load(self.scene)
        self.assertTrue(speed_check.oscillation_left_out(scene, 1))
        excited = self.SCENE.replace('time_function = "worn"', 'time_function = "turning"\nexcitation = "worn"')
        self.assertFalse(speed_check.oscillation_left_out(scenes.load(self.write("excited.toml", excited)), 0))


class RigTorqueTest(FolderTest):
    """Strings that a torque turns, not a speed: the steady rotation needs what friction takes."""
    SCENE = SCENE.replace('component = "rx"', 'component = "rx"\nkind = "load"').replace("100 rpm", "5 N m").replace(
        "[speeds]", '[speeds]\nspin = "100 rpm"').replace("[response]", '[response]\nspin = "100 rpm"')

    def test_torque_of_friction(self):
        """Of a round string the wall takes T = mu N r, N being all normal forces of the wall; v / sqrt(v^2 + v_eps^2)
        of it at v = 10 rad/s x r."""
        text = self.SCENE.replace('eccentricity = "0.5 mm"\n', "").replace('mass = "6 kg"\ndiameter = "94 mm"',
                                                                           'mass = "6 kg"\ndiameter = "73 mm"')
        scene = scenes.load(self.write("round.toml", text))
        turned, torque = rig_torque.balanced(scene, {"slip_rotation": 10.0})
        with turned.new_sim() as sim:
            sim.static(slip_rotation=10.0)
            wall = sim.contact_total().normal_force
        self.assertGreater(wall, 1000.0)
        self.assertAlmostEqual(torque * math.hypot(1.0, 1e-3 / 0.365) / (0.3 * wall * 0.0365), 1.0, delta=1e-7)

    def test_same_amplitude_as_by_speed(self):
        """Lateral amplitudes below the resonance are those of the string that a speed turns to 1 %, the part in which
        its rotation swings."""
        severity = {}
        for name, text in (("torque", self.SCENE), ("speed", SCENE.replace("[speeds]", '[speeds]\nspin = "100 rpm"'))):
            notes = []
            found = critical_speeds.analyse(scenes.load(self.write(f"{name}.toml", text)),
                                            lambda sim, state: sim.static(**state.static), notes.append)
            self.assertEqual((notes, found.state.refused, found.state.torque is None), ([], False, name == "speed"))
            severity[name] = numpy.array(found.severity[:6])
        numpy.testing.assert_allclose(severity["torque"], severity["speed"], rtol=1e-2)

    def test_said(self):
        for command in ("speeds", "response"):
            out, summary = self.results(command)
            self.assertRegex(out, r"slides on the wall at 100 rpm, turned by [0-9.]+ N m, which friction takes")
            self.assertGreater(summary["linear_state"]["torque_N_m"], 5.0)

    def test_shipped_scene(self):
        """The steered rig turns by a torque: its sliding state is there, at both ends of the range of friction too."""
        self.scene = EXAMPLES / "steered_rig.toml"
        _, summary = self.results("speeds")
        self.assertTrue(summary["speeds_assessed"])
        self.assertEqual(summary["speeds_range"]["not_assessed"], 0)

    def test_left_alone(self):
        """Nothing is balanced where a speed is prescribed, two drives turn, the string does not turn, or the held
        string has no state."""
        slip = {"slip_rotation": 10.0}
        speed, torque = scenes.load(self.write("speed.toml", SCENE)), scenes.load(self.scene)
        two = scenes.load(self.write("two.toml", self.SCENE
                                     + '[[drive]]\nkind = "load"\ncomponent = "rx"\ntime_function = "turning"\n'))
        for scene, static in ((speed, slip), (two, slip), (torque, {})):
            self.assertEqual(rig_torque.balanced(scene, static), (scene, None))
        with unittest.mock.patch.object(mbd.Sim, "static",
                                        side_effect=mbd.Error(mbd.ERR_NO_CONVERGENCE, "no solution")):
            self.assertEqual(rig_torque.balanced(torque, slip), (torque, None))


class NoResponseTest(SpeedsTest):
    """An output that only rounding moves has no response, and no all-clear."""
    SCENE = SCENE.replace("100 rpm", "0 rpm").replace("[[time_function]]", 'inclination = "0 deg"\n[[time_function]]',
                                                      1).replace(
        'eccentricity = "0.5 mm"', "").replace('[[response.excitation]]\nkind = "eccentricity"',
                                               '[[response.excitation]]\nkind = "drive"\nplace = "head"\n'
                                               'amplitude = "1 rpm"').replace("[[speeds.order]]",
                                                                              '[[speeds.order]]\nkind = "drive"\nplace '
                                                                              '= "head"\n'
                                                                              'amplitude = "1 rpm"')

    def peaks(self, text):
        self.scene = self.write("one.toml", text)
        out, summary = self.results("response")
        return out, summary["response"]["middle [m]" if "middle [m]" in summary["response"] else "middle [rad]"]

    def test_response(self):
        """Torsion of an upright string moves no rod across; without an amplitude nothing is excited; the rotation
        itself responds."""
        out, peak = self.peaks(self.SCENE)
        self.assertIn("middle [m]: no response, because the excitation moves the string, but not this output", out)
        self.assertIsNone(peak["amplitude"])
        out, peak = self.peaks(self.SCENE.replace("1 rpm", "0 rpm"))
        self.assertIn("not assessed, because all excitations are zero", out)
        turning = self.SCENE.replace('"vibration-y"', '"vibration-rz"').replace('"1 um"', '"1 deg"')
        out, peak = self.peaks(turning)
        self.assertGreater(peak["amplitude"], 1e-4)

    def test_speeds(self):
        self.scene = self.write("one.toml", self.SCENE)
        out, summary = self.results("speeds")
        self.assertIn("not assessed, because the orders of [speeds] excite none of its outputs", out)
        self.assertNotIn("no critical speed", out)
        self.assertFalse(summary["speeds_assessed"])
        self.assert_no_verdict()

    def test_a_silent_output_beside_one_that_moves(self):
        """Torsion turns an upright string and does not move it across: the second output is named, and no speed is
        called free."""
        turning = ('[[speeds.output]]\nname = "turning"\nplace = {part = "main", pipe = 6}\nquantity = '
                   '"vibration-rz"\nlimit = "1e6 deg"\n')
        self.scene = self.write("beside.toml", self.SCENE + turning)
        out, summary = self.results("speeds")
        self.assertIn("middle [m]: not assessed, because the excitation moves the string, but not this output", out)
        self.assertNotIn("turning [rad]: not assessed", out)
        self.assertNotIn("no critical speed", out)
        self.assertFalse(summary["speeds_assessed"])
        scene = scenes.load(self.scene)
        found = critical_speeds.analyse(scene, lambda sim, state: sim.static(**state.static), print)
        self.assertEqual(found.unmoved, [0])
        self.assertEqual(speed_check._linear(found, 10.0), "not assessed")
        speeds = report_linear.speeds(scene, print)
        tile = report_linear.speeds_tile(speeds, operating(scene))
        self.assertEqual(tile.verdict, "NOT ASSESSED")
        demands = {key: Demand(key, "N", None) for key in ("push", "pull", "torque")}
        tiles = [*(Tile(key, "", "", "NOT ASSESSED") for key in demands), tile]
        rows = {str(row[0]): str(row[1]) for row in report_basis.limits_at_the_rig(demands, tiles, speeds,
                                                                                   operating(scene), SI)}
        self.assertEqual(rows["Rotary speed"], "not known: not all outputs and orders were assessed")

    def test_a_silent_output_over_a_range(self):
        """No case of the range is called free of critical speeds."""
        turning = ('[[speeds.output]]\nname = "turning"\nplace = {part = "main", pipe = 6}\nquantity = '
                   '"vibration-rz"\nlimit = "1e6 deg"\n')
        self.scene = self.write("beside.toml", self.SCENE + turning + RANGE)
        out, summary = self.results("speeds")
        self.assertRegex(out, r"\(4 cases, all combinations\): not assessed; 4 of the 4 cases")
        self.assertEqual(summary["speeds_range"]["not_assessed"], 4)

    def test_a_silent_order_is_no_all_clear(self):
        """One order that moves no output beside one that does: no speed is called free of critical ones, by the command
        and its check."""
        self.scene = self.write("two.toml", SCENE.replace("threshold = 100", "threshold = 1e6")
                                + '[[speeds.order]]\norder = 2\nkind = "drive"\n'
                                'place = "feed"\namplitude = "0 mm/s"\n')
        out, summary = self.results("speeds")
        self.assertIn("speeds: not assessed, because 1 of the 2 orders move no output", out)
        self.assertNotIn("no critical speed", out)
        self.assertFalse(summary["speeds_assessed"])
        scene = scenes.load(self.scene)
        found = critical_speeds.analyse(scene, lambda sim, state: sim.static(**state.static), print)
        for change in ({}, {"silent": no_response.NOTHING_EXCITES}):
            self.assertEqual(speed_check._linear(dataclasses.replace(found, **change), 10.0), "not assessed")
        whole = scenes.load(self.write("whole.toml", SCENE.replace("threshold = 100", "threshold = 1e6")))
        found = critical_speeds.analyse(whole, lambda sim, state: sim.static(**state.static), print)
        self.assertEqual(speed_check._linear(found, 10.0), "free")
        refused = dataclasses.replace(found, state=dataclasses.replace(found.state, refused=True))
        self.assertEqual(speed_check._linear(refused, 10.0), "not assessed")

    def test_bounds(self):
        """Below 1e-9 of a comparable amplitude is rounding, above it is not; an output of another unit is none only if
        it is 0."""
        move, turn = mbd.output_of("vibration_y"), mbd.output_of("vibration_rx")
        force = mbd.output_of("contact_friction_axial")
        self.assertIs(no_response._judged(1e-16, move, [(turn, 1e-3)]), no_response.NO_RESPONSE)
        self.assertIsNone(no_response._judged(1e-11, move, [(turn, 1e-3)]))
        self.assertIsNone(no_response._judged(1e-16, force, [(turn, 1e-3)]))
        self.assertIs(no_response._judged(0.0, force, [(turn, 1e-3)]), no_response.NO_RESPONSE)
        self.assertIs(no_response._judged(0.0, force, [(turn, 0.0)]), no_response.NOTHING_EXCITES)


class RangeTest(FolderTest):
    """Critical bands over what the scene gives as uncertain."""
    SCENE = SCENE

    def test_union(self):
        self.assertEqual(speed_range.union([(5.0, 6.0), (1.0, 2.0), (1.5, 3.0), (3.0, 4.0)]), [(1.0, 4.0), (5.0, 6.0)])

    def test_no_range_is_said(self):
        out, summary = self.results("speeds")
        self.assertIn("range: not assessed, because the scene gives no uncertain diameter or friction", out)
        self.assertIsNone(summary["speeds_range"])
        hint = re.search(r"keys = \[.*?\] and relative = true", out)[0].replace(" and ", "\n")
        self.scene = self.write("hint.toml", SCENE
                                + f'[[variability.scatter]]\n{hint}\ndistribution = "uniform"\nlow = 0.7\nhigh = 1.3\n')
        self.assertEqual(self.results("speeds")[1]["speeds_range"]["not_assessed"], 0)

    def test_the_reason_of_an_incomplete_static_state(self):
        """The note is the library's message, which its status refers to."""
        from drillmbd.results import CommandOutput
        out = unittest.mock.Mock(units=SI)
        CommandOutput.note(out, mbd.NOTE_INCOMPLETE, "static", "static: the stability is not resolved")
        out.note_text.assert_called_once_with("static: the stability is not resolved")
        CommandOutput.note(out, mbd.NOTE_UNSTABLE, "static", "static: another text")
        self.assertIn("not stable", out.note_text.call_args[0][0])

    def test_a_gap_between_the_bands_of_a_range(self):
        """The bands of both ends are apart, and that of the middle lies between them: speeds there are not called
        free."""
        found = {}
        for high in (1.1, 1.2):
            scatter = ('[[variability.scatter]]\nkey = "hole.diameter"\nrelative = true\ndistribution = '
                       f'"uniform"\nlow = 1\nhigh = {high}\n')
            self.scene = self.write(f"gap{high}.toml",
                                    SCENE.replace('threshold = 100',
                                                  'threshold = 3000').replace('speed_high = "240 rpm"',
                                                                              'speed_high = "300 rpm"') + scatter)
            out, summary = self.results("speeds")
            found[high] = summary["speeds_range"]["bands_rpm"]
            self.assertEqual("speeds between these bands are not shown to be free" in out, len(found[high]) > 1, out)
        self.assertGreater(len(found[1.2]), 1, found)
        (_, low), (high, _) = found[1.2][:2]
        self.assertTrue(any(a < high and b > low for a, b in found[1.1]), found)

    def test_band_over_range(self):
        """The band of the range begins where that of its widest hole does, and covers that of each breakpoint."""
        text = SCENE.replace('threshold = 100', 'threshold = 1000')
        self.scene = self.write("range.toml", text + RANGE)
        out, summary = self.results("speeds")
        self.assertIn("over the range of friction (0.2 .. 0.4), diameter (0.094 .. 0.104 m) (4 cases, all "
                      "combinations)", out)
        ranges = summary["speeds_range"]["bands_rpm"]
        lows = []
        for diameter in ("94 mm", "104 mm"):
            for mu in (0.2, 0.4):
                breakpoint = self.write("breakpoint.toml", text.replace('"94 mm"', f'"{diameter}"',
                                                                        1).replace("0.30", str(mu)))
                self.scene = breakpoint
                for band in self.results("speeds")[1]["speeds"]:
                    lows.append(band["low_rpm"])
                    self.assertTrue(any(low <= band["low_rpm"] + 1e-6 and band["high_rpm"] <= high + 1e-6
                                        for low, high in ranges))
        self.assertAlmostEqual(min(low for low, _ in ranges), min(lows), 6)
        self.assertGreater(max(lows) - min(lows), 5.0)


class CheckTest(FolderTest):
    """Speeds in time."""
    SCENE = SCENE

    def test_marks(self):
        """A slow string is steady; one at the resonance of the rod on the bottom of its hole is not. Numbers of the
        table."""
        self.scene = self.write("check.toml", SCENE.replace('speed_high = "240 rpm"', 'speed_high = "300 rpm"'))
        out, summary = self.results("speeds", "--check", "2")
        rows = summary["speeds_check"]["speeds"]
        self.assertEqual([row["time"] for row in rows][0], "steady", out)
        self.assertIn("torque oscillates", rows[1]["time"], out)
        self.assertIn("avoid in time: 300 rpm", out)
        self.assertIn("s by the clock", out)
        with open(self.folder / "out" / "speeds_check.csv", encoding="utf-8") as file:
            table = list(csv.reader(file))
        self.assertEqual(table[0][:3], ["speed [rpm]", "linear", "in time"])
        self.assertAlmostEqual(float(table[1][3]), rows[0]["torque_N_m"])
        self.assertIn("speeds_check.png", summary["files"])
        weight = 9.81 * (12 * 1.5 * 7850 * math.pi / 4 * (0.073 ** 2 - 0.059 ** 2) + 6)
        self.assertAlmostEqual(rows[0]["torque_N_m"] / (0.3 * weight / math.sqrt(1.09) * 0.0365), 1.0, 0)

    def test_what_cannot_be_checked(self):
        self.assertIn("outside 2 .. 100", self.call("speeds", self.scene, "--check", "1", status=2))
        load = self.write("load.toml",
                          SCENE.replace('component = "rx"',
                                        'component = "rx"\nkind = "load"').replace("100 rpm", "0 N m").replace(
            'eccentricity = "0.5 mm"', ""))
        out = self.call("speeds", load, "--check")
        self.assertIn("check in time: not assessed, because no drive turns the string", out)

    def test_a_failed_run_is_no_all_clear(self):
        failed = speed_check.Result(10.0, error="no solution")
        self.assertEqual(failed.verdict, speed_check.FAILED)
        self.assertEqual(speed_check.Result(10.0, 5.0, 0.6, 1.0).verdict, "torque oscillates")
        self.assertEqual(speed_check.Result(10.0, 5.0, 0.4, 10.0).verdict, "lateral acceleration")

    def test_a_string_that_turns_freely(self):
        """Torque is left of the start only, about a smaller mean: it does not oscillate. Shaken by a load it does."""
        text = SCENE.replace("= 0.30", "= 0.0")
        self.assertNotEqual(text, SCENE)
        for change in ("", 'kind = "axial-torsional"'):
            self.scene = self.write("free.toml", text.replace('eccentricity = "0.5 mm"', change))
            out, summary = self.results("speeds", "--check", "2")
            self.assertEqual([row["time"] for row in summary["speeds_check"]["speeds"]], ["steady"] * 2, out)
            self.scene = self.write("shaken.toml", Path(self.scene).read_text(encoding="utf-8") + SHAKEN)
            out, summary = self.results("speeds", "--check", "2")
            self.assertEqual([row["time"] for row in summary["speeds_check"]["speeds"]], ["torque oscillates"] * 2, out)

    def test_torsional_waves(self):
        """Torque of a wave sqrt(G rho) J w and the period 4 L/c, by the diameters and by the section."""
        pipe = {"length": 2.0, "outer_diameter": 0.073, "inner_diameter": 0.059, "young_modulus": 2.1e11,
                "poisson_ratio": 0.3, "density": 7850.0}
        polar, shear = math.pi / 32.0 * (0.073 ** 4 - 0.059 ** 4), 2.1e11 / 2.6
        section = {"section_stiffness": (0.0, 0.0, 0.0, 4.0 * shear * polar, 0.0, 0.0),
                   "section_inertia": (9.0 * 7850.0 * polar, 0.0)}
        for more, wave, time in (({}, 1.0, 1.0), (section, 6.0, 1.5)):
            scene = unittest.mock.Mock(model=unittest.mock.Mock(calls=[("add_pipes", (5, {**pipe, **more})),
                                                                       ("add_pipes", (5, pipe))]))
            known = 3.0 * wave * polar * math.sqrt(7850.0 * shear)
            self.assertAlmostEqual(speed_check.wave_torque(scene, 3.0) / known, 1.0)
            self.assertAlmostEqual(speed_check.slowest_period(scene) / (80.0 * time / math.sqrt(shear / 7850.0)), 1.0)

    def test_a_string_that_stays_on_its_axis(self):
        """Axial-torsional pipes have no lateral acceleration, which is no assessment of it."""
        text = SCENE.replace('eccentricity = "0.5 mm"', 'kind = "axial-torsional"')
        self.assertIn("lateral acceleration is not assessed", self.call("speeds", self.write("axial.toml", text),
                                                                        "--check", "2"))
        self.assertNotIn("lateral acceleration is not assessed", self.call("speeds", self.scene, "--check", "2"))

    def test_own_rotation_is_among_the_speeds(self):
        scene = scenes.load(self.scene)
        found = type("Found", (), {"grid": [60.0 * rotating.RPM, 240.0 * rotating.RPM]})
        courses = speed_check._courses(scene, found, 4, 0)
        self.assertEqual([round(one.speed / rotating.RPM) for one in courses], [60, 100, 180, 240])
        period = 4.0 * 18.0 / math.sqrt(2.1e11 / 2.6 / 7850.0)
        self.assertAlmostEqual(speed_check.slowest_period(scene), period)


TABLE = 'friction_table = [["0 m/s", 0.5], ["70 mm/s", 0.5], ["140 mm/s", 0.25]]\n'


class FrictionTableTest(FolderTest):
    """The coefficient of the wall against the speed of sliding."""
    SCENE = SCENE.replace("mu_static = 0.30\nmu_dynamic = 0.30\n", TABLE)

    def test_written_and_read(self):
        first = scenes.load(self.scene)
        self.call("save", self.scene, self.folder / "copy.toml")
        self.assertTrue(first.same_as(scenes.load(self.folder / "copy.toml")))
        wall = mbd.WallDef(**first.model.calls[0][1][0])
        self.assertEqual((wall.friction_table_count, wall.mu_static, wall.mu_dynamic), (3, 0.5, 0.25))
        self.assertEqual(first.model.hole(1.0).mu_dynamic, 0.25)

    def test_torque_by_speed(self):
        """The torque of a string that slides is mu(v) times that of a coefficient of 1, by both laws."""
        def torque(speed, law, table):
            text = SCENE.replace("mu_static = 0.30\nmu_dynamic = 0.30\n",
                                 f'friction_law = "{law}"\nsmoothing_speed = "0.01 mm/s"\n' + table)
            scene = scenes.load(self.write("one.toml",
                                           text.replace("0.5 mm", "0 mm").replace('mass = "6 kg"\ndiameter = "94 mm"',
                                                                                  'mass = "6 kg"\ndiameter = "73 mm"')))
            with scene.new_sim() as sim:
                sim.static(slip_rotation=speed / 0.0365)
                return abs(sim.drive(scene.names["head"]).force)

        def expected(mu):
            return torque(1.0, "coulomb", f"mu_static = {mu}\nmu_dynamic = {mu}\n")

        for law in ("stribeck", "bristle"):
            for speed, mu in ((0.03, 0.5), (0.105, 0.375), (0.5, 0.25)):
                self.assertAlmostEqual(torque(speed, law, TABLE) / expected(mu), 1.0, 4, (law, speed))

    def test_refusals(self):
        for old, new, wanted in (
                (TABLE, TABLE + "mu_static = 0.4\n", "must be left out where there is a friction_table"),
                (TABLE, TABLE + 'friction_law = "coulomb"\n', "must be stribeck or bristle"),
                ('["0 m/s", 0.5], ', "", "friction_table_speed[0] = 0.07"),
                ('"70 mm/s"', '"170 mm/s"', "friction_table_speed[2]"),
                ('0.25]]', '0.0]]', "friction_table_mu"),
                ('["70 mm/s", 0.5]', '["70 mm/s", -0.5]', "friction_table_mu[1]"),
                (TABLE, 'friction_table = [["0 m/s", 0.5]]\n', "must have 2 to 8 pairs"),
                ('[[time_function]]', '[[hole.section]]\ndepth = "2 m"\nmu_static = 0.4\n[[time_function]]',
                 "mu_static")):
            text = self.SCENE.replace(old, new, 1)
            self.assertNotEqual(text, self.SCENE, new)
            self.assertIn(wanted, self.call("check", self.write("wrong.toml", text), status=2))

    def test_sections_scale_it(self):
        """A section with half the dynamic coefficient has half the static one too."""
        text = self.SCENE.replace("[[time_function]]",
                                  '[[hole.section]]\ndepth = "2 m"\nmu_dynamic = 0.125\n[[time_function]]', 1)
        point = scenes.load(self.write("section.toml", text)).model.hole(5.0)
        self.assertAlmostEqual(point.mu_static, 0.25)
        out = self.call("torque-drag", self.folder / "section.toml", "-o", self.folder / "td")
        self.assertIn("broomstick: 0.5, 1 and 1.5 times", out)


if __name__ == "__main__":
    unittest.main()
