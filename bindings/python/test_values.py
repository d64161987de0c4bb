"""Tests of what Python hands over: values of wrong types, sizes and enumerations, parts and places that do not fit,
objects that were given back. Each is an Error that tells part, field, value and bound, and nothing is changed."""
import io
import math
import unittest
import warnings

import drillmbd as mbd
from drillmbd import scene

NAN, HUGE = math.nan, 10 ** 400


def string_in_hole():
    """A model of five pipes in a hole, its string and its feed."""
    model = mbd.Model()
    model.add_wall()
    string = model.add_pipes(5)
    feed = model.add_drive(time_function=model.add_time_function(0.01))
    model.compile()
    return model, string, feed


class ShortPaths(unittest.TestCase):
    def test_constant_drive_and_ramp(self):
        """A drive of a value is one of a constant time function; a ramp is one segment; a file says both by a time
        function."""
        states = []
        for constant in (True, False):
            model = mbd.Model()
            model.add_wall()
            model.add_pipes(3)
            ramp = model.add_ramp(0.0, 2.0, end=0.01)
            model.add_drive(**({"value": 0.02} if constant else {"time_function": model.add_time_function(0.02)}))
            model.add_drive(component=mbd.RX, time_function=ramp)
            model.compile()
            with model.sim() as sim:
                sim.steps(1e-3, 20)
                states.append((sim.hash(), sim.output("drive_speed", model.ids[-1])))
            if constant:
                saved = scene.saves(model)
                self.assertIn('time_function = "0.02 m/s"', saved)
                with scene.loads(saved).new_sim() as sim:
                    sim.steps(1e-3, 20)
                    states.append((sim.hash(), states[0][1]))
        self.assertEqual(len(set(states)), 1)
        self.assertAlmostEqual(states[0][1], 2.0)


class Refusals(unittest.TestCase):
    def refused(self, call, *arguments, **fields):
        with self.assertRaises(mbd.Error) as caught:
            call(*arguments, **fields)
        return caught.exception

    def tells(self, parts, call, *arguments, **fields):
        """part, field, value of the Error, and that it has a bound."""
        error = self.refused(call, *arguments, **fields)
        self.assertEqual((error.part, error.field, error.value), parts, error.message)
        self.assertTrue(error.bound, error.message)
        return error


class FieldTest(Refusals):
    def test_numbers(self):
        for given, value in (("3", "'3'"), (None, "None"), ([1], "[1]"), (2j, "2j"), (b"3", "b'3'")):
            error = self.tells(("PipeDef", "length", value), mbd.PipeDef, length=given)
            self.assertIsInstance(error, TypeError)
            self.assertEqual(error.bound, "be a number [m]")
        self.assertIsInstance(self.refused(mbd.PipeDef, length=HUGE), ValueError)
        self.assertEqual(mbd.PipeDef(length=True).length, 1.0)

    def test_whole_numbers_do_not_wrap(self):
        """2^32 + 1 elements were 1, 2^32 + 2 pipes were 2."""
        for value in (2 ** 32 + 1, -1):
            self.tells(("PipeDef", "elements", value), mbd.PipeDef, elements=value)
            self.tells(("pipes", "count", value), mbd.Model().add_pipes, value)
        for value in (2.0, "3", None):
            self.assertIsInstance(self.refused(mbd.PipeDef, elements=value), TypeError)
            self.assertIsInstance(self.refused(mbd.Model().add_pipes, value), TypeError)
        self.tells(("Place", "pipe", -1.0), mbd.station, mbd.Id(1, 1), -1)

    def test_constants_of_another_enumeration(self):
        error = self.refused(mbd.PipeDef, kind=mbd.JOINT_REVOLUTE)
        self.assertEqual((error.field, error.bound), ("kind", "be PIPE_..."))
        error = self.refused(mbd.DriveDef, component=mbd.DRIVE_LOAD)
        self.assertEqual((error.field, error.bound), ("component", "be X .. RZ"))
        self.assertEqual(mbd.StringDef(start_free=mbd.FREE_ALL & ~mbd.FREE_X).start_free,
                         mbd.FREE_YZ | mbd.FREE_SPHERICAL)
        self.assertEqual(mbd.ResponseOptions(axes=mbd.RESPONSE_AXES_AT_REST).axes, mbd.RESPONSE_AXES_AT_REST)

    def test_every_default_fits_its_field(self):
        for struct in mbd.STRUCTS.values():
            if issubclass(struct, mbd._Sized):
                made = struct()
                self.assertEqual(struct(**made.describe()), made, struct.c_name)

    def test_sequences(self):
        self.tells(("EnvironmentDef", "gravity", "(1, 2)"), mbd.EnvironmentDef, gravity=(1, 2))
        self.tells(("EnvironmentDef", "gravity[2]", "'3'"), mbd.EnvironmentDef, gravity=[1, 2, "3"])
        for value in ("abc", 5, None):
            self.assertIsInstance(self.refused(mbd.EnvironmentDef, gravity=value), TypeError)
        if mbd.numpy is not None:
            numpy = mbd.numpy
            self.assertEqual(mbd.EnvironmentDef(gravity=numpy.array([1, 2, 3], dtype=numpy.float32)).gravity[2], 3.0)
            self.assertEqual(mbd.PipeDef(length=numpy.float32(2.0), elements=numpy.int64(3)).elements, 3)
            for wrong in (numpy.zeros(2), numpy.zeros((3, 3)), numpy.zeros(3, dtype=complex),
                          numpy.array(["1", "2", "3"])):
                self.assertEqual(self.refused(mbd.EnvironmentDef, gravity=wrong).part, "EnvironmentDef")

    def test_texts(self):
        self.tells(("PipeDef", "name", 3), mbd.PipeDef, name=3)
        self.assertEqual(self.refused(mbd.PipeDef, name="x" * 24).bound, "be of at most 23 bytes without 0")
        self.assertEqual(self.refused(mbd.PipeDef, name="a\0b").field, "name")  # it was cut off there
        self.assertEqual(mbd.PipeDef(name="\u00e4" * 11).name.decode(), "\u00e4" * 11)

    def test_names_of_fields(self):
        with self.assertRaisesRegex(AttributeError, "'diameter'"):
            mbd.WallDef(diametre=0.1)

    def test_tables(self):
        for table in (5, "ab", {0: 1}, [(0, 1, 2)], [(0, 1), (1,)], [("0", 1)], ([0, 1, 2], [1, 2])):
            self.assertTrue(self.refused(mbd.Segment, table=table).field.startswith("table"))
        self.assertEqual(self.refused(mbd.Motor, table=[(i, i) for i in range(16)]).part, "Motor")
        self.assertEqual(self.refused(mbd.SpringDef, table=[(0, 1, 2)]).part, "SpringDef")
        for stations in ("abc", [], [(0, 1)], 5):
            self.assertTrue(self.refused(mbd.WallDef, stations=stations).field.startswith("stations"))

    def test_time_functions(self):
        model = mbd.Model()
        self.tells(("segment 0 of a time function", "value", "'1'"), model.add_time_function, "1")
        self.assertEqual(self.refused(mbd.Segment, function=3).field, "function")
        for kind in (mbd.SEGMENT_PER_REVOLUTION, mbd.SEGMENT_HARMONIC, mbd.SEGMENT_CONSTANT):
            self.assertEqual(self.refused(mbd.Segment, kind=kind, table=[(0, 0), (1, 1)]).field, "kind")
        self.assertEqual(model.calls, [])

    def test_parts_in_fields(self):
        self.assertEqual(mbd.DriveDef(part=None).part, mbd.Id())
        self.assertEqual(mbd.EventDef(output=(None, "hook_load")).output.quantity, mbd.OUTPUT_HOOK_LOAD)
        self.tells(("DriveDef", "part", "'rods'"), mbd.DriveDef, part="rods")
        self.tells(("LoadDef", "place", 3), mbd.LoadDef, place=3)
        self.assertEqual(self.refused(mbd.ForceDef, places="head", function=len).field, "places")

    def test_definitions(self):
        error = self.refused(mbd.Model().add_wall, 0.094)
        self.assertIn("by name", error.bound)

    def test_what_a_function_returns(self):
        for returned in ("x", None, [0.1], 1j):
            model = mbd.Model()
            model.add_pipes(2)
            model.add_drive(time_function=model.add_time_function(lambda time: returned))
            model.compile()
            error = self.refused(model.sim)
            self.assertEqual(error.status, mbd.ERR_CALLBACK)
            self.assertEqual(error.__cause__.field, "result of the function")
        model = mbd.Model()
        body = model.add_body(mass=1.0)
        model.add_force(places=[body], function=lambda time, poses, speeds: "abcdef")
        model.compile()
        self.assertIsInstance(self.refused(model.sim).__cause__, TypeError)  # was a RecursionError


class AnalysisTest(Refusals):
    def setUp(self):
        self.model, self.string, self.feed = string_in_hole()
        self.sim = self.model.sim()

    def test_places(self):
        sim, string = self.sim, self.string
        self.assertEqual(list(sim.pose(string).position), list(sim.pose(mbd.station(string)).position))
        self.tells(("pose at string 0", "pipe", 5.0), sim.pose, mbd.station(string, 5))
        self.tells(("section at string 0", "fraction", 1.5), sim.section, mbd.station(string, 1, 1.5))
        self.tells(("pose", "part", "drive 0"), sim.pose, self.feed)
        self.tells(("pose", "part", "none"), sim.pose, None)
        self.assertEqual(self.refused(sim.pose, "rods").field, "place")
        other = string_in_hole()[1]
        error = self.tells(("rotation", "part", "string 0 of another model"), sim.rotation, mbd.station(other))
        self.assertIn("own(part)", error.advice)

    def test_parts(self):
        sim = self.sim
        self.tells(("drive", "part", "string 0"), sim.drive, self.string)
        self.tells(("joint", "part", "none"), sim.joint, None)
        self.tells(("reaction", "part", "drive 0"), sim.reaction, self.feed)
        self.assertEqual(self.refused(sim.bit, 3).field, "part")
        self.tells(("contact", "number", 99.0), sim.contact, 99)
        self.tells(("drive", "value", "'5'"), sim.set_drive, self.feed, "5")
        self.tells(("hole", "depth", "'5'"), self.model.hole, "5")
        self.assertEqual(self.refused(self.model.hole, NAN).bound, "be finite")  # it told of the compilation

    def test_times(self):
        sim = self.sim
        self.tells(("step", "duration", "'1'"), sim.step, "1")
        self.tells(("advance", "time", "None"), sim.advance, None)
        for end in (NAN, math.inf, "1"):
            self.assertEqual(self.refused(sim.run, end).field, "end")  # NaN ran nowhere and said nothing
        for step in (0, -1, NAN, math.inf, "a"):
            self.assertEqual(self.refused(sim.run, 0.01, step).field, "step")
        sim.step(0.01)
        self.assertEqual(self.refused(sim.run, 0.005).value, 0.005)
        self.assertEqual(self.refused(sim.run, 0.02, progress=3).field, "progress")

    def test_after_compile(self):
        for call in (self.model.add_pipes, self.model.compile):
            self.tells(("model", "state", "compiled"), call)  # it told what the compilation had told

    def test_snapshots(self):
        for wrong in ("abc", 5):
            self.assertIsInstance(self.refused(self.sim.restore, wrong), TypeError)
        self.assertIsInstance(self.refused(self.sim.transfer_state, 5), TypeError)

    def test_files(self):
        self.assertIn("/nonexistent/x.vtp", self.refused(self.sim.write_vtk, "/nonexistent/x.vtp").value)
        self.tells(("hole", "depth1", 1.0), self.model.write_vtk_hole, "x", 5.0, 1.0)
        recorder = self.sim.recorder([(self.string, "position_x")], 3)
        self.assertEqual(self.refused(recorder.write_csv, "/nonexistent/x.csv").status, mbd.ERR_IO)

    def test_analyses(self):
        sim = self.sim
        sim.static(steady=mbd.STEADY_AT_REST)
        place = mbd.station(self.string, 2, 0.5)
        modes = sim.modes(count=3)
        self.assertEqual(modes[-1].frequency, modes[2].frequency)
        with self.assertRaises(IndexError):
            modes[3]
        self.tells(("modes", "index", 9.0), modes.shape, 9, place)
        self.tells(("shape at string 0", "pipe", 7.0), modes.shape, 0, mbd.station(self.string, 7))
        shaken, requested = [mbd.Excitation(place=place, component=mbd.Z)], [(place, "vibration_z")]
        response = sim.response(shaken, requested, points=3)
        self.tells(("response", "output", 2.0), response.transfer, 0, 2)
        self.assertEqual(self.refused(sim.response, shaken[0], requested).field, "excitations")
        self.assertEqual(self.refused(sim.response, requested, requested).field, "excitations[0]")
        self.assertEqual(self.refused(sim.response, shaken, requested, frequencies=["5"]).field, "frequencies[0]")
        self.assertEqual(self.refused(sim.speeds, [mbd.Order()], requested, []).field, "limits")

    def test_torque_drag(self):
        sim = self.sim
        by_name = sim.torque_drag(["pick-up"]).column("hook_load")
        self.assertEqual(by_name, sim.torque_drag([mbd.OPERATION_PICK_UP]).column("hook_load"))
        self.assertEqual(self.refused(sim.torque_drag, ["drilling"]).part, "operation")
        self.assertEqual(self.refused(sim.torque_drag, []).field, "operations")
        self.assertEqual(self.refused(sim.torque_drag, depths=5.0).field, "depths")
        self.assertEqual(self.refused(sim.torque_drag_profile, 0, -1).field, "stations")

    def test_outputs(self):
        self.assertEqual(self.refused(self.sim.output, "hookload").advice, "'hook_load'?")
        for outputs in ([3.0], [("position_x", self.string)], [(self.string, "position_x", 3)]):
            self.assertEqual(self.refused(self.sim.recorder, outputs, 5).part, "recorder output 0")
        error = self.refused(self.sim.recorder, [(self.string, "drive_force")], 5)
        self.assertIn("place.part must be a drive", error.message)  # at once, not at the first row
        for capacity in (0, -1, 2.5):
            self.assertEqual(self.refused(self.sim.recorder, [(None, "hook_load")], capacity).field, "capacity")
        self.assertEqual(self.refused(self.sim.recorder, [(None, "hook_load")], 5, NAN).field, "interval")
        self.assertEqual(self.refused(self.sim.window, [3.0]).part, "window output 0")


class TakerTest(Refusals):
    def test_recorder_of_another_sim(self):
        """It took the state of its own sim again and again, and nothing told."""
        model, string, _ = string_in_hole()
        one, other = model.sim(), model.sim()
        recorder = one.recorder([(string, "position_x")], 100)
        self.assertEqual(self.refused(other.run, 0.01, 1e-3, recorder=recorder).field, "recorder")
        window = one.window([(None, "bit_speed")])
        self.assertEqual(self.refused(other.run, 0.01, 1e-3, counters=[window]).field, "counters")
        self.assertEqual(other.time, 0.0)

    def test_full_recorder(self):
        model, string, _ = string_in_hole()
        sim = model.sim()
        recorder = sim.recorder([(string, "position_x")], 3)
        with self.assertWarnsRegex(RuntimeWarning, "full"):
            done = sim.run(0.01, 1e-3, recorder=recorder)
        self.assertEqual((done.status, len(recorder)), (mbd.NOTE_FULL, 3))
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            done = sim.run(0.02, 1e-3, recorder=sim.recorder([(string, "position_x")], 30))
        self.assertEqual(done.status, mbd.OK)

    def test_bar(self):
        from drillmbd.running import Bar

        class Terminal(io.StringIO):
            def isatty(self):
                return True

        model, _, _ = string_in_hole()
        sim, terminal = model.sim(), Terminal()
        bar = Bar(0.0, 0.01, terminal)
        sim.run(0.01, step=1e-3, progress=bar, every=0.0)
        bar.close()
        self.assertIn("100", terminal.getvalue())
        self.assertIn("0.01/0.01 s", terminal.getvalue())
        sim.run(0.02, step=1e-3, progress=True)  # nobody looks: nothing is shown
        self.assertAlmostEqual(sim.time, 0.02)


class ClosedTest(Refusals):
    """Objects that were given back say so; the memory of arrays stays."""

    def closed(self, kind, *functions):
        for function in functions:
            error = self.refused(function)
            self.assertEqual((error.status, error.part, error.field), (mbd.ERR_HANDLE, kind, "handle"), error.message)

    def test_sim(self):
        model, string, _ = string_in_hole()
        sim = model.sim()
        recorder = sim.recorder([(string, "position_x")], 5)
        recorder.take()
        table = recorder.table
        sim.close()
        self.closed("sim", lambda: sim.time, lambda: sim.step(1e-3), lambda: sim.run(1.0), sim.hash, sim.snapshot,
                    sim.static,
                    sim.modes, sim.energy, sim.check, sim.check_text, lambda: sim.pose(string), recorder.take,
                    lambda: sim.output("position_x", string))
        self.assertEqual(len(table), 1)
        self.assertEqual(table[0][1], 0.0)

    def test_model(self):
        model, string, _ = string_in_hole()
        sim = model.sim()
        model.close()
        self.closed("model", model.sim, model.info, model.add_wall, lambda: model.find("x"), lambda: "x" in model)
        sim.step(1e-3)  # sims go on

    def test_results(self):
        model, string, _ = string_in_hole()
        sim = model.sim()
        sim.static(steady=mbd.STEADY_AT_REST)
        modes, window = sim.modes(count=2), sim.window([(None, "bit_speed")])
        sim.close()
        self.assertGreater(modes[1].frequency, 0.0)  # what was found stays
        modes.close()
        window.close()
        self.closed("modes", lambda: modes[0], lambda: modes.shape(0, string))
        self.closed("window", window.result, window.reset)


if __name__ == "__main__":
    unittest.main()
