"""Tests of the Python binding: every struct, constant and function as the C compiler sees them, a scene from end to end,
errors, callbacks, and objects that go in any order."""
import ctypes
import gc
import math
import os
import pathlib
import pickle
import re
import signal
import tempfile
import threading
import unittest
import weakref

import drillmbd as mbd
from drillmbd.scene.fields import words_of

LAYOUT = pathlib.Path(__file__).resolve().parents[2] / "tests" / "abi" / "layout.txt"


# ---- The interface as stored -----------------------------------------------------------------------------------------
def stored_structs():
    """{name: (size, [(member, offset, size)])}"""
    found = {}
    for line in LAYOUT.read_text(encoding="utf-8").splitlines():
        struct = re.match(r"struct (\w+): (\d+)$", line)
        member = re.match(r"    (\w+): at (\d+), (\d+)$", line)
        if struct:
            members = []
            found[struct.group(1)] = (int(struct.group(2)), members)
        elif member:
            members.append((member.group(1), int(member.group(2)), int(member.group(3))))
    return found


def stored_constants():
    return {name: int(value) for name, value in
            re.findall(r"^constant DMB_(\w+) = (-?\d+)$", LAYOUT.read_text(encoding="utf-8"), re.M)}


def stored_prototypes():
    """{function: (result, [argument])}"""
    found = {}
    for line in LAYOUT.read_text(encoding="utf-8").splitlines():
        match = re.match(r"(?!typedef|struct|constant)(.*?)(dmb_\w+)\((.*)\)$", line)
        if match:
            arguments = [] if match.group(3) == "void" else match.group(3).split(", ")
            found[match.group(2)] = (match.group(1).strip(), arguments)
    return found


def ctypes_of(declaration):
    """The types that may stand for an argument 'const dmb_pose *pose' in ctypes."""
    plain = {"int32_t": ctypes.c_int32, "uint32_t": ctypes.c_uint32, "double": ctypes.c_double,
             "size_t": ctypes.c_size_t, "uint64_t": ctypes.c_uint64, "void": ctypes.c_void_p, "char": ctypes.c_char_p,
             "dmb_model": ctypes.c_void_p, "dmb_sim": ctypes.c_void_p, "dmb_buckling": ctypes.c_void_p,
             "dmb_response": ctypes.c_void_p, "dmb_modes": ctypes.c_void_p, "dmb_fatigue": ctypes.c_void_p,
             "dmb_sensitivity": ctypes.c_void_p, "dmb_state_equation": ctypes.c_void_p,
             "dmb_window": ctypes.c_void_p, "dmb_state_space": ctypes.c_void_p, "dmb_progress_fn": mbd.PROGRESS_FN, "dmb_step_fn": mbd.STEP_FN,
             **mbd.STRUCTS}
    kind, stars, array = re.match(r"(?:const )?(\w+) (\**)\w+(\[\d+\])?$", declaration).groups()
    depth = len(stars) + bool(array)
    opaque = kind in ("dmb_model", "dmb_sim", "dmb_buckling", "dmb_response", "dmb_modes", "dmb_fatigue", "dmb_sensitivity", "dmb_state_equation", "dmb_window",
                      "dmb_state_space", "char", "void")
    base = plain[kind]
    for _ in range(depth - 1 if opaque else depth):
        base = ctypes.POINTER(base)
    return base


class InterfaceTest(unittest.TestCase):
    def test_all_structs_are_there(self):
        self.assertEqual(set(mbd.STRUCTS), set(stored_structs()))

    def test_sizes_are_those_of_the_compiler(self):
        for name, (size, _) in stored_structs().items():
            self.assertEqual(ctypes.sizeof(mbd.STRUCTS[name]), size, name)

    def test_fields_are_those_of_the_compiler(self):
        for name, (_, members) in stored_structs().items():
            struct = mbd.STRUCTS[name]
            mirrored = [(field, getattr(struct, field).offset, getattr(struct, field).size)
                        for field, *_ in struct._fields_]
            self.assertEqual(mirrored, members, name)

    def test_numbers_are_of_the_right_kind(self):
        """Sizes alone do not tell a double from an integer: every field of 8 bytes that the library fills by default
        reads as the documented value."""
        self.assertEqual(mbd.WallDef().diameter, 0.094)
        self.assertEqual(mbd.PipeDef().young_modulus, 2.1e11)
        self.assertEqual(mbd.PipeDef().seed, 1)
        self.assertEqual(list(mbd.EnvironmentDef().gravity), [0.0, 0.0, -9.81])
        self.assertEqual(mbd.DriveDef().limit_low, -1e30)
        self.assertEqual(mbd.CompileOptions().pipe_kind, -1)
        self.assertEqual(mbd.SimOptions().max_iterations, 12)
        self.assertEqual(mbd.BitDef().history, 1024)
        self.assertEqual(mbd.JointDef().stop_stiffness, 1e6)
        self.assertEqual(list(mbd.JointDef().axis_b), [1.0, 0.0, 0.0])
        self.assertEqual(list(mbd.CouplingDef().component), [mbd.RX, mbd.RX])
        self.assertEqual(mbd.ConstraintDef().row_count, 1)

    def test_constants_are_equal(self):
        constants = stored_constants()
        self.assertGreater(len(constants), 80)
        for name, value in constants.items():
            self.assertEqual(getattr(mbd, name), value, name)

    def test_statuses_have_their_names(self):
        for name, value in stored_constants().items():
            if name.startswith(("ERR_", "NOTE_")) or name == "OK":
                self.assertEqual(mbd.status_name(value), "DMB_" + name)

    def test_functions_have_their_types(self):
        prototypes = stored_prototypes()
        self.assertGreater(len(prototypes), 70)
        results = {"int32_t": ctypes.c_int32, "void": None, "double": ctypes.c_double, "uint32_t": ctypes.c_uint32,
                    "size_t": ctypes.c_size_t, "const char *": ctypes.c_char_p, "const dmb_sim *": ctypes.c_void_p}
        for name, (result, arguments) in prototypes.items():
            function = getattr(mbd._lib, name)
            self.assertIs(function.restype, results[result], name)
            self.assertEqual(list(function.argtypes), [ctypes_of(argument) for argument in arguments], name)

    def test_init_writes_the_size(self):
        for name, struct in mbd.STRUCTS.items():
            if issubclass(struct, mbd._Sized):
                self.assertEqual(struct().struct_size, ctypes.sizeof(struct), name)

    def test_version_fits(self):
        self.assertEqual(mbd._lib.dmb_version() // 10000, mbd.VERSION[0])


class StructTest(unittest.TestCase):
    def test_misspelt_field_is_an_error(self):
        with self.assertRaises(AttributeError):
            mbd.WallDef(diametre=0.1)
        wall = mbd.WallDef()
        with self.assertRaises(AttributeError):
            wall.diametre = 0.1

    def test_array_takes_a_sequence_of_its_length(self):
        wall = mbd.WallDef(direction=(0, 1, 0))
        self.assertEqual(list(wall.direction), [0.0, 1.0, 0.0])
        wall.origin = [1, 2, 3]
        self.assertEqual(list(wall.origin), [1.0, 2.0, 3.0])
        with self.assertRaises(ValueError):
            wall.origin = [1, 2]

    def test_survey_and_table_are_kept(self):
        wall = mbd.WallDef(stations=[(0, math.pi / 2, 0), (30, 1.6, 0.1)])
        term = mbd.Segment(table=[(0, 1), (2, 5), (3, -1)])
        gc.collect()
        self.assertEqual(wall.survey_count, 2)
        self.assertEqual(wall.survey[3], 30.0)
        self.assertEqual((term.kind, term.table_count, term.table_value[2]), (mbd.SEGMENT_TABLE, 3, -1.0))

    def test_ids_compare_by_value(self):
        self.assertEqual(mbd.Id(1, 2), mbd.Id(1, 2))
        self.assertNotEqual(mbd.Id(1, 2), mbd.Id(1, 3))
        self.assertEqual(len({mbd.Id(1, 2), mbd.Id(1, 2)}), 1)
        self.assertFalse(mbd.Id())

    def test_repr_shows_the_fields(self):
        self.assertIn("diameter=0.094", repr(mbd.WallDef()))
        self.assertIn("gravity=[0.0, 0.0, -9.81]", repr(mbd.EnvironmentDef()))


# ---- A scene ---------------------------------------------------------------------------------------------------------
class Rig:
    """A short string in a hole, fed and turned."""

    def __init__(self, pipes=5):
        self.model = mbd.Model()
        self.model.add_wall(diameter=0.094)
        self.string = self.model.add_pipes(pipes, outer_diameter=0.073, inner_diameter=0.061)
        self.bit = self.model.add_bit(mass=5.0)
        self.feed_time_function = self.model.add_time_function(mbd.Segment(kind=mbd.SEGMENT_STEP, x1=0.02, h1=0.05))
        self.feed = self.model.add_drive(time_function=self.feed_time_function)
        self.turning = self.model.add_drive(kind=mbd.DRIVE_CONTROL, component=mbd.RX, gain=100.0,
                                            time_function=self.model.add_time_function(10.0))
        self.model.compile()
        self.tip = mbd.station(self.string, pipes - 1, 1.0)


class SceneTest(unittest.TestCase):
    def setUp(self):
        self.rig = Rig()
        self.sim = self.rig.model.sim()

    def tearDown(self):
        self.sim.close()
        self.rig.model.close()

    def run_to(self, time, step=1e-3):
        while self.sim.time < time - 0.5 * step:
            self.sim.step(step)

    def test_counts(self):
        info = self.rig.model.info()
        self.assertEqual((info.strings, info.pipes, info.prescribed), (1, 5, 1))
        self.assertAlmostEqual(info.length, 5.0)
        self.assertEqual(self.rig.model.sim_memory_size(), info.sim_bytes)

    def test_run_and_query(self):
        self.run_to(0.05)
        pose, motion = self.sim.pose(self.rig.tip), self.sim.motion(self.rig.tip)
        self.assertAlmostEqual(self.sim.time, 0.05)
        self.assertAlmostEqual(pose.displacement[0], self.sim.drive(self.rig.feed).position, places=4)
        self.assertAlmostEqual(self.sim.drive(self.rig.feed).speed, 0.05)
        self.assertAlmostEqual(motion.velocity[0], 0.05, places=2)
        self.assertLess(pose.position[2], 0.0)
        self.assertGreater(self.sim.rotation(self.rig.tip), 0.0)
        self.assertEqual(len(self.sim.section(mbd.station(self.rig.string, 2, 0.5)).force), 6)
        self.assertGreater(self.sim.kinetic_energy(self.rig.string, 2), 0.0)
        self.assertEqual(self.sim.contact_total().closed,
                         sum(self.sim.contact(i).closed for i in range(self.rig.model.info().contact_points)))
        self.assertAlmostEqual(self.sim.momentum().mass, self.rig.model.info().mass)
        self.assertEqual(len(self.sim.reaction(self.rig.string)), 6)
        self.assertEqual(self.sim.bit(self.rig.bit).weight, 0.0)
        self.assertEqual(self.sim.statistics().steps, self.sim.statistics().steps)
        self.assertGreater(self.sim.energy().kinetic, 0.0)

    def test_report_of_a_step(self):
        report = self.sim.step(1e-3)
        self.assertEqual((report.status, report.steps, report.time), (mbd.OK, 1, 1e-3))
        report = self.sim.advance(0.005)
        self.assertGreaterEqual(report.status, 0)
        self.assertEqual(report.time, 0.005)

    def test_bound_on_steps(self):
        with self.rig.model.sim(max_steps=3) as sim:
            self.assertEqual(sim.advance(1.0).status, mbd.NOTE_STOPPED)
            self.assertLess(sim.time, 1.0)

    def test_snapshot_and_hash(self):
        self.run_to(0.01)
        snapshot, middle = self.sim.snapshot(), self.sim.hash()
        self.run_to(0.02)
        end = self.sim.hash()
        with self.rig.model.sim() as other:
            other.restore(snapshot)
            self.assertEqual(other.hash(), middle)
            for _ in range(10):
                other.step(1e-3)
            self.assertEqual(other.hash(), end)

    def test_drive_by_hand(self):
        self.sim.set_drive(self.rig.turning, -5.0)
        self.run_to(0.05)
        self.assertLess(self.sim.drive(self.rig.turning).speed, 0.0)
        self.sim.set_drive(self.rig.turning, None)
        self.sim.step(1e-3)
        self.assertEqual(self.sim.drive(self.rig.turning).target, 10.0)

    def test_events(self):
        model = mbd.Model()
        string = model.add_pipes(1)
        drive = model.add_drive(part=string, time_function=model.add_time_function(0.5))
        for name, level in (("far", 0.02), ("near", 0.01), ("with it", 0.01)):
            model.add_event(name=name, output=mbd.Output(place=mbd.station(string, 0, 0.0)), level=level)
        model.add_event(name="fast", output=mbd.Output(place=mbd.station(drive, 0, 0.0), quantity=mbd.OUTPUT_DRIVE_SPEED),
                        level=1.0)
        model.compile()
        with model.sim() as sim:
            self.assertEqual(sim.advance_to_event(1.0), ["near", "with it"])
            self.assertAlmostEqual(sim.time, 0.02, delta=2e-9)
            self.assertEqual(sim.advance_to_event(1.0), ["far"])
            self.assertEqual((sim.advance_to_event(1.0), sim.time), ([], 1.0))
        with model.sim() as sim:
            names, crossing = sim.steps_to_event(0.015, 10)
            self.assertEqual((names, sim.time), (["near", "with it"], 0.03))
            self.assertAlmostEqual(crossing, 0.02, delta=1e-12)
            self.assertEqual(sim.steps_to_event(0.015, 10)[0], ["far"])
            self.assertEqual(sim.steps_to_event(0.015, 3)[0], [])
        self.assertTrue(pickle.loads(pickle.dumps(model)).same_scene(model))

    def test_inputs(self):
        model = mbd.Model()
        string = model.add_pipes(1)
        drive = model.add_drive(part=string, kind=mbd.DRIVE_CONTROL, component=mbd.RX, gain=5.0, time_function=model.add_time_function(1.0))
        model.add_input(name="rotation", part=drive, low=0.0, high=20.0, rate_limit=2.0, outside=mbd.OUTSIDE_CLAMPED)
        model.add_input(name="gain", part=drive, target=mbd.TARGET_GAIN)
        model.compile()
        sim, other = model.sim(), model.sim()
        self.assertEqual(list(sim.inputs), ["rotation", "gain"])
        self.assertEqual(sim.inputs.info["rotation"].unit, b"rad/s")
        self.assertEqual((sim.inputs["rotation"], sim.inputs["gain"]), (1.0, 5.0))
        log = sim.inputs.record()
        sim.inputs["rotation"] = 12.0
        self.assertEqual(sim.inputs.set({"rotation": 50.0, "gain": 6.0}), mbd.NOTE_CLAMPED)
        for _ in range(20):
            sim.step(0.01)
        self.assertAlmostEqual(sim.inputs.state("rotation").present, 1.4)
        self.assertEqual(sim.inputs["rotation"], 20.0)
        self.assertEqual([record.value for record in log.take()], [12.0, 20.0, 6.0])
        self.assertEqual(other.inputs.replay(log.take()), 3)
        for _ in range(20):
            other.step(0.01)
        self.assertEqual(sim.hash(), other.hash())
        with self.assertRaises(mbd.Error):
            sim.inputs.set({"gain": -1.0})
        self.assertRaises(KeyError, sim.inputs.__getitem__, "no such")
        twin = pickle.loads(pickle.dumps(model))
        self.assertTrue(twin.same_scene(model))

    def test_recorder(self):
        recorder = self.sim.recorder([(self.rig.tip, mbd.OUTPUT_POSITION_X), (self.rig.feed, mbd.OUTPUT_DRIVE_SPEED),
                                      (None, mbd.OUTPUT_ENERGY_ERROR)], capacity=6, interval=2e-3)
        for _ in range(10):
            self.assertEqual(recorder.take(), mbd.OK)
            self.sim.step(1e-3)
        table = recorder.table
        self.assertEqual(len(recorder), 5)
        self.assertEqual([round(float(row[0]), 9) for row in table], [0.0, 0.002, 0.004, 0.006, 0.008])
        self.assertAlmostEqual(float(table[-1][1]), 5.0, places=3)
        if mbd.numpy is not None:
            self.assertEqual(table.shape, (5, 4))
        recorder.take()
        self.sim.step(2e-3)
        self.assertEqual(recorder.take(), mbd.NOTE_FULL)

    def test_recorder_without_numpy(self):
        numpy, mbd.recorder.numpy = mbd.recorder.numpy, None
        try:
            recorder = self.sim.recorder([(self.rig.tip, mbd.OUTPUT_POSITION_X)], capacity=3)
            recorder.take()
            self.assertEqual(len(recorder.table), 1)
            self.assertAlmostEqual(recorder.table[0][1], 5.0)
        finally:
            mbd.recorder.numpy = numpy

    def test_files(self):
        with tempfile.TemporaryDirectory() as folder:
            recorder = self.sim.recorder([(self.rig.tip, mbd.OUTPUT_POSITION_X)], capacity=3)
            recorder.take()
            recorder.write_csv(os.path.join(folder, "table.csv"))
            self.sim.write_vtk(pathlib.Path(folder, "string.vtp"))
            self.rig.model.write_vtk_hole(os.path.join(folder, "hole.vtp"), 0.0, 5.0)
            self.assertTrue(pathlib.Path(folder, "table.csv").read_text().startswith("time [s],position_x"))
            self.assertEqual(len(os.listdir(folder)), 3)
            with self.assertRaises(mbd.Error) as caught:
                self.sim.write_vtk(os.path.join(folder, "none", "string.vtp"))
            self.assertEqual(caught.exception.status, mbd.ERR_IO)

    def test_threads_do_not_disturb_each_other(self):
        hashes = []

        def work():
            with self.rig.model.sim() as sim:
                for _ in range(20):
                    sim.step(1e-3)
                hashes.append(sim.hash())

        threads = [threading.Thread(target=work) for _ in range(4)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        self.assertEqual(len(hashes), 4)
        self.assertEqual(len(set(hashes)), 1)


class ResponseTest(unittest.TestCase):
    """A body that a force shakes: x/F = 1/(-m w^2)."""

    def setUp(self):
        model = mbd.Model()
        model.set_environment(gravity=[0.0, 0.0, 0.0])
        self.body = model.add_body(mass=2.0)
        model.compile()
        self.sim = model.sim()

    def test_free_body(self):
        force = mbd.Excitation(place=self.body, amplitude=3.0, phase=math.pi / 2)
        response = self.sim.response([force], [(self.body, "vibration_x"),
            (self.body, "vibration_acceleration_x")], frequencies=[0.5, 2.0, 8.0])
        self.assertEqual(response.shape, (3, 1, 2))
        self.assertEqual(list(response.frequencies), [0.5, 2.0, 8.0])
        for f, x, a, all_a in zip(response.frequencies, response.transfer(0, 0), response.transfer(0, 1),
                                  response.transfer(output=1)):
            self.assertAlmostEqual(x * (2.0 * math.pi * f) ** 2, -0.5)
            self.assertAlmostEqual(a, 0.5)
            self.assertAlmostEqual(all_a, 1.5j)

    def test_grid_and_table(self):
        response = self.sim.response([mbd.Excitation(place=self.body)], [(self.body, "vibration_x")], points=5,
                                     frequency_low=1.0, frequency_high=16.0, logarithmic=1)
        for got, want in zip(response.frequencies, (1, 2, 4, 8, 16)):
            self.assertAlmostEqual(got, want)
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder, "response.csv")
            response.write_csv(path)
            lines = path.read_text(encoding="utf-8").splitlines()
        self.assertEqual(len(lines), 6)
        self.assertTrue(lines[0].startswith("frequency [Hz],amplitude of vibration_x of body 0 for excitation 0 [m per unit],"))
        self.assertAlmostEqual(float(lines[1].split(",")[1]), 0.5 / (2.0 * math.pi) ** 2)

    def test_stepped_sine(self):
        model = mbd.Model()
        body = model.add_body(mass=2.0, free_mask=mbd.FREE_X)
        shake = model.add_time_function(mbd.Segment(kind=mbd.SEGMENT_HARMONIC, h1=3.0, omega=2.0 * math.pi * 5.0))
        model.add_drive(kind=mbd.DRIVE_LOAD, part=body, component=mbd.X, time_function=shake)
        model.compile()
        (amplitudes,), report = model.sim().stepped_sine(5.0, [(body, "vibration_acceleration_x")],
                                                 harmonics=2)
        self.assertEqual((report.status, report.settled, report.windows), (mbd.OK, 1, 3))
        self.assertAlmostEqual(amplitudes[0], 0.0)
        self.assertAlmostEqual(amplitudes[1], -1.5j)  # sine: the real part of -i e^(iwt)
        self.assertAlmostEqual(amplitudes[2], 0.0)

    def test_speeds(self):
        """m r w^2 / (m w^2) = r: the same at every speed, above a limit and below another."""
        order = mbd.Order(excitation=mbd.Excitation(kind=mbd.EXCITATION_UNBALANCE, place=self.body, amplitude=1e-3))
        output = mbd.output_of((self.body, "vibration_x"))
        bands, severity = self.sim.speeds([order], [output], [4e-4], speed_low=5.0, speed_high=20.0, points=7)
        self.assertEqual(len(bands), 1)
        self.assertEqual((bands.status, bands.report.truncated, bands[0].truncated), (mbd.NOTE_INCOMPLETE, 3, 3))
        self.assertEqual((bands.report.silent_orders, bands.report.undamped), (0, 0))
        self.assertEqual((bands[0].low, bands[0].high, bands[0].order), (5.0, 20.0, 0))
        for value in severity:
            self.assertAlmostEqual(value, 1.25)
        self.assertEqual(self.sim.speeds([order], [output], [6e-4], speed_low=5.0, speed_high=20.0)[0], [])

    def test_refusal_says_why(self):
        with self.assertRaises(mbd.Error) as caught:
            self.sim.response([mbd.Excitation(place=self.body)], [(self.body, "vibration_x")], frequencies=[0.0])
        self.assertEqual(caught.exception.name, "DMB_ERR_SINGULAR")
        self.assertIn("body 0", caught.exception.message)


class ModesTest(unittest.TestCase):
    def setUp(self):
        model = mbd.Model()
        model.set_environment(gravity=(0.0, 0.0, 0.0))
        self.string = model.add_pipes(4)
        model.compile()
        self.sim = model.sim()

    def test_frequencies_and_shapes(self):
        before = self.sim.hash()
        modes = self.sim.modes(count=8)
        self.assertEqual(self.sim.hash(), before)
        self.assertEqual((len(modes), modes.info.rigid, modes[0].rigid), (8, 2, 1))
        frequencies = [mode.frequency for mode in modes]
        self.assertEqual(frequencies, sorted(frequencies))
        self.assertAlmostEqual(sum(modes[2].share[:]), 1.0)
        tip = modes.shape(2, mbd.station(self.string, 3, 1.0))
        self.assertGreater(math.hypot(tip.re[1], tip.re[2]), 0.1)
        kinetic, strain = modes.part(2, self.string)
        self.assertAlmostEqual(kinetic / modes[2].kinetic, 1.0)
        self.assertAlmostEqual(strain / modes[2].strain, 1.0)

    def test_band(self):
        modes = self.sim.modes(select=mbd.MODES_BAND, band=(1.0, 100.0), kind=mbd.MODES_DAMPED)
        self.assertTrue(all(1.0 <= mode.frequency <= 100.0 for mode in modes))

    def test_whirl(self):
        modes = self.sim.modes(count=4, kind=mbd.MODES_DAMPED, axes=mbd.MODES_AXES_AT_REST, spin=20.0)
        self.assertGreater(abs(modes[2].whirl), 0.9)
        self.assertAlmostEqual(modes[2].whirl, -modes[3].whirl)

    def test_animation(self):
        modes = self.sim.modes(count=3)
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder, "mode.vtp")
            modes.write_vtk(2, path, scale=0.1, per_element=2)
            self.assertIn('Name="rotation"', path.read_text(encoding="utf-8"))

    def test_refusal_says_why(self):
        with self.assertRaises(mbd.Error) as caught:
            self.sim.modes(count=1000)
        self.assertEqual(caught.exception.name, "DMB_ERR_VALUE")
        self.assertIn("coordinates", caught.exception.message)


class WholeModelTest(unittest.TestCase):
    """Features that the rig above does not use."""

    def test_every_kind_of_part(self):
        with mbd.Model() as model:
            model.set_environment(fluid_density=1000.0, gravity=(0, 0, -9.8))
            model.add_wall(stations=[(0, math.pi / 2, 0), (10, math.pi / 2, 0), (40, 1.6, 0.05)],
                           friction_law=mbd.FRICTION_BRISTLE)
            string = model.add_string(start_free=mbd.FREE_CYLINDRICAL)
            model.add_pipes(2, string=string, kind=mbd.PIPE_RIGID)
            model.add_pipes(2, mbd.PipeDef(string=string, joint_length=0.1, eccentricity=1e-3))
            model.add_body(attach=mbd.ATTACH_START, string=string, mass=30.0)
            body = model.add_body(mass=2.0, position=(5, 0, 0))
            load = model.add_time_function(mbd.Segment(kind=mbd.SEGMENT_HARMONIC, h1=1.0, omega=30.0), 0.5,
                                       mbd.Segment(table=[(0, 0), (0.01, 1)]))
            bit = model.add_bit(rock_law=mbd.ROCK_RATE, load=load)
            model.add_load(place=mbd.station(body), force=(10, 0, 0), time_function=load)
            model.add_drive(kind=mbd.DRIVE_LOAD, part=body, time_function=load, excitation=load)
            self.assertEqual(model.compile(features=mbd.FEATURE_ALL & ~mbd.FEATURE_DAMPING), mbd.OK)
            with model.sim(spectral_radius=0.9, energy_ledger=0) as sim:
                for _ in range(20):
                    sim.step(1e-3)
                self.assertTrue(math.isfinite(sim.pose(mbd.station(bit)).position[0]))
                self.assertGreater(sim.motion(mbd.station(body), mbd.FRAME_BODY).velocity[0], 0.0)
                with self.assertRaises(mbd.Error) as caught:
                    sim.energy()
                self.assertEqual(caught.exception.name, "DMB_ERR_UNSUPPORTED")

    def test_static_start(self):
        with mbd.Model() as model:
            model.add_wall(diameter=0.094)
            model.add_pipes(10, string=model.add_string(start_free=mbd.FREE_NONE))
            model.compile()
            weight = 9.81 * model.info().mass
            with model.sim() as sim:
                report = sim.static()
                self.assertEqual((report.status, report.method), (mbd.OK, mbd.STATIC_NEWTON))
                self.assertLess(report.residual, 1e-9)
                self.assertGreater(sim.contact_total().normal_force, 0.5 * weight)

    def test_buckling_of_a_clamped_column(self):
        with mbd.Model() as model:
            model.set_environment(gravity=(0.0, 0.0, 0.0))
            string = model.add_string(follows_hole=0, start_free=mbd.FREE_NONE)
            model.add_pipes(10, string=string, section_stiffness=(1e12, 1e12, 1e12, 1e5, 1e5, 1e5))
            push = model.add_load(place=mbd.station(string, 9, 1.0), force=(-1.0, 0.0, 0.0),
                                  time_function=model.add_time_function(0.0))
            model.compile()
            with model.sim() as sim:
                sim.static()
                with sim.buckling(scale=mbd.SCALE_PART, part=push, count=2) as found:
                    self.assertEqual(found.status, mbd.OK)
                    for factor in found.factors:
                        self.assertAlmostEqual(factor / (math.pi ** 2 * 1e5 / 400.0), 1.0, 4)
                    tip, middle = (found.shape(0, mbd.station(string, *at)) for at in ((9, 1.0), (4, 1.0)))
                    length = math.hypot(*tip[1:3])
                    self.assertAlmostEqual(math.hypot(*middle[1:3]) / length, 1.0 - math.cos(math.pi / 4.0), 4)

    def test_path_of_a_clamped_column(self):
        with mbd.Model() as model:
            model.set_environment(gravity=(0.0, 0.0, 0.0))
            string = model.add_string(follows_hole=0, start_free=mbd.FREE_NONE)
            model.add_pipes(10, string=string, section_stiffness=(1e12, 1e12, 1e12, 1e5, 1e5, 1e5))
            tip = mbd.station(string, 9, 1.0)
            push = model.add_load(place=tip, force=(-1.0, 0.0, 0.0), time_function=model.add_time_function(0.0))
            model.compile()
            with model.sim() as sim:
                sim.static()
                euler, before, tips = math.pi ** 2 * 1e5 / 400.0, sim.hash(), []

                def visit(at, point):
                    tips.append((point.kind, at.pose(tip).displacement[0], point.displacement))
                    return point.displacement < -0.5

                settings = dict(scale=mbd.SCALE_PART, part=push, place=tip, factor_end=4.0 * euler, branch=1,
                                branch_size=0.05)
                report = sim.path(visit, **settings)
                self.assertEqual(report.status, mbd.NOTE_STOPPED)
                self.assertEqual(sim.hash(), before)
                self.assertAlmostEqual(report.first_bifurcation / euler, 1.0, 4)
                self.assertIn(mbd.PATH_BRANCH, [kind for kind, _, _ in tips])
                for _, requested, told in tips:
                    self.assertEqual(requested, told)

                def raises(at, point):
                    raise KeyError(point.number)

                with self.assertRaises(KeyError):
                    sim.path(raises, **settings)

    def test_projected_start_is_a_note(self):
        with mbd.Model() as model:
            string = model.add_string(start_free=mbd.FREE_NONE, velocity=(0.1, 0, 0, 0, 0, 0))
            model.add_pipes(1, string=string)
            model.compile()
            sim = model.sim()
            self.assertEqual(sim.status, mbd.NOTE_PROJECTED)
            self.assertIn("projected", sim.message)

    def test_log_is_told(self):
        lines = []
        with mbd.Model(log=lambda level, text: lines.append((level, text))) as model:
            with self.assertRaises(mbd.Error):
                model.add_wall(diameter=-1.0)
            model.add_pipes(1)
            model.clear_refused()
            model.compile()
        self.assertEqual([level for level, _ in lines], [mbd.LOG_ERROR, mbd.LOG_INFO])
        self.assertIn("diameter", lines[0][1])


# ---- Errors and callbacks -------------------------------------------------------------------------------------------
def assert_step_fails(test, sim):
    """The next step ends by the error that a callback of the scene raises, and changes nothing."""
    before = sim.hash()
    with test.assertRaises(mbd.Error) as caught:
        sim.step(1e-3)
    test.assertEqual(caught.exception.status, mbd.ERR_CALLBACK)
    test.assertIsInstance(caught.exception.__cause__, ZeroDivisionError)
    test.assertEqual(sim.hash(), before)


class JointTest(unittest.TestCase):
    """A pendulum of two rods: a hinge on the ground, and a hinge, a spring or a function between the rods."""

    def rods(self):
        model = mbd.Model()
        inertia = (1e-3, 1e-2, 1e-2, 0, 0, 0)
        upper = model.add_body(mass=2.0, position=(0.5, 0, 0), inertia=inertia)
        lower = model.add_body(mass=1.0, position=(1.5, 0, 0), inertia=inertia)
        hinge = model.add_joint(kind=mbd.JOINT_REVOLUTE, name="hinge", place_b=upper, axis_a=(0, 1, 0), match=1)
        return model, upper, lower, hinge

    def test_joint(self):
        model, upper, lower, hinge = self.rods()
        elbow = model.add_joint(kind=mbd.JOINT_REVOLUTE, place_a=upper, place_b=lower, origin_a=(0.5, 0, 0),
                                axis_a=(0, 1, 0), match=1, state=mbd.JOINT_LOCKED)
        model.compile()
        info = model.info()
        self.assertEqual((info.joints, info.constraint_rows, info.clusters, info.reduced_nodes), (2, 11, 1, 2))
        with model.sim() as sim:
            for _ in range(50):
                sim.step(1e-3)
            state = sim.joint(hinge)
            self.assertEqual((state.state, state.constraint_rows, state.redundant), (mbd.JOINT_ACTIVE, 5, 0))
            self.assertGreater(state.speed[mbd.RX], 0.1)  # it falls: z up, turns from x to -z about y
            self.assertLess(max(map(abs, state.position[:3])), 1e-9)
            self.assertLess(abs(sim.joint(elbow).speed[mbd.RX]), 1e-9)
            self.assertEqual(len(sim.multipliers(hinge)), 5)
            self.assertEqual(len(sim.multipliers(elbow)), 6)
            self.assertGreaterEqual(sim.set_joint(elbow, mbd.JOINT_ACTIVE), mbd.OK)
            sim.step(1e-3)
            self.assertEqual(len(sim.multipliers(elbow)), 5)
            self.assertLess(sim.statistics().violation, 1e-9)
            world, body = sim.joint(hinge), sim.joint(hinge, mbd.FRAME_BODY)
            length = [math.hypot(*s.reaction[:3]) for s in (world, body)]
            self.assertAlmostEqual(length[0], length[1])

    def test_function(self):
        model, upper, lower, hinge = self.rods()
        rod = model.add_constraint(places=[upper, lower], name="rod",
                                   function=lambda time, poses: math.dist(poses[0][:3], poses[1][:3]) - 1.0)
        model.compile()
        with model.sim() as sim:
            for _ in range(50):
                sim.step(1e-3)
            ends = [sim.pose(mbd.station(body)).position for body in (upper, lower)]
            self.assertAlmostEqual(math.dist(*ends), 1.0, places=6)
            self.assertEqual(len(sim.multipliers(rod)), 1)

    def test_function_with_jacobian(self):
        """The lower rod's axis stays level: its direction's z component is that of the matrix's first column."""
        def level(_time, poses):
            r = poses[0][3:]
            return r[6], [[0, 0, 0, 0, -r[8], r[7]]]

        model, _, lower, _ = self.rods()
        model.add_constraint(places=[lower], function=level, provides=mbd.PROVIDES_JACOBIAN)
        model.compile()
        with model.sim() as sim:
            for _ in range(20):
                sim.step(1e-3)
            self.assertAlmostEqual(sim.pose(mbd.station(lower)).rotation[2, 0] if mbd.numpy else 0.0, 0.0)

    def test_function_that_raises(self):
        armed = []  # the time of a call may lie a little ahead: derivatives along the motion are differences

        def broken(_time, _poses):
            if armed:
                raise ZeroDivisionError("on purpose")
            return 0.0, [0.0] * 6

        model, upper, _, _ = self.rods()
        model.add_constraint(places=[upper], function=broken, provides=mbd.PROVIDES_JACOBIAN)
        model.compile()
        with model.sim() as sim:
            sim.step(1e-3)
            armed.append(True)
            assert_step_fails(self, sim)

    def test_coupling_and_drive(self):
        model, upper, lower, hinge = self.rods()
        elbow = model.add_joint(kind=mbd.JOINT_REVOLUTE, place_a=upper, place_b=lower, origin_a=(0.5, 0, 0),
                                axis_a=(0, 1, 0), match=1)
        model.add_coupling(joint=(hinge, elbow), ratio=-2.0)
        drive = model.add_drive(part=hinge, component=mbd.RX, time_function=model.add_time_function(mbd.Segment(
            kind=mbd.SEGMENT_STEP5, x1=0.1, h1=1.0)))
        model.compile()
        with model.sim() as sim:
            for _ in range(200):
                sim.step(1e-3)
            self.assertAlmostEqual(sim.joint(hinge).speed[mbd.RX], 1.0, places=6)
            self.assertAlmostEqual(sim.joint(elbow).speed[mbd.RX], -0.5, places=6)
            self.assertAlmostEqual(sim.drive(drive).speed, 1.0, places=6)

    def test_errors_name_the_joint(self):
        model, upper, _, _ = self.rods()
        with self.assertRaises(mbd.Error) as caught:
            model.add_joint(name="crank", place_b=upper, axis_a=(0, 0, 0))
        self.assertEqual(caught.exception.message, "joint 1 (crank): axis_a = 0, must be of length > 0")

    def test_rods_added(self):
        """A string that goes on in a model with one pipe more at the rig end."""
        def drilling(pipes):
            model = mbd.Model()
            model.add_pipes(pipes)
            model.compile()
            return model

        with drilling(3).sim() as short:
            for _ in range(5):
                short.step(1e-3)
            with drilling(4).sim() as long:
                self.assertGreaterEqual(long.transfer_state(short), mbd.OK)
                self.assertEqual(long.time, short.time)


class ErrorTest(unittest.TestCase):
    def assert_error(self, status, function, *arguments, **fields):
        with self.assertRaises(mbd.Error) as caught:
            function(*arguments, **fields)
        self.assertEqual(caught.exception.name, mbd.status_name(status))
        self.assertEqual(caught.exception.status, status)
        self.assertTrue(caught.exception.message)
        return caught.exception

    def test_value_tells_part_and_field(self):
        with mbd.Model() as model:
            error = self.assert_error(mbd.ERR_VALUE, model.add_pipes, 3, inner_diameter=0.08)
            self.assertIn("outer_diameter", error.message)
            self.assertIn("DMB_ERR_VALUE", str(error))
            self.assert_error(mbd.ERR_NOT_FINITE, model.add_wall, diameter=math.nan)
            self.assert_error(mbd.ERR_VALUE, model.add_pipes, 0)

    def test_inertia_of_no_body(self):
        with mbd.Model() as model:
            error = self.assert_error(mbd.ERR_VALUE, model.add_body, inertia=(0.3, 0.001, 0.001, 0, 0, 0))
            self.assertIn("principal moments 0.3, 0.001, 0.001", error.message)
            self.assert_error(mbd.ERR_VALUE, model.add_bit, inertia=(0.3, 0.1))
            model.add_body(inertia=(0.002, 0.001, 0.001, 0, 0, 0))

    def test_handled_refusal_does_not_stop_compile(self):
        with mbd.Model() as model:
            for fields in ({"inner_diameter": 0.08}, {"inner_diameter": 0.09, "length": 2.0}):
                self.assert_error(mbd.ERR_VALUE, model.add_pipes, 3, outer_diameter=0.07, **fields)
            model.add_pipes(3, outer_diameter=0.07, inner_diameter=0.06)
            for diameter in (-1.0, 0.0):
                error = self.assert_error(mbd.ERR_VALUE, model.add_wall, diameter=diameter)
            self.assertEqual(model.message, error.message)
            model.add_wall(diameter=0.1)
            model.compile()

    def test_reason_of_a_failed_create(self):
        with mbd.Model() as model:
            model.add_pipes(1)
            model.compile()
            error = self.assert_error(mbd.ERR_VALUE, model.sim, spectral_radius=2.0)
            self.assertIn("spectral_radius = 2", error.message)
            self.assertEqual(model.message, error.message)
            model.sim().close()
            self.assertIn("compiled", model.message)

    def test_order(self):
        with mbd.Model() as model:
            model.add_pipes(1)
            self.assert_error(mbd.ERR_ORDER, model.sim)
            self.assert_error(mbd.ERR_ORDER, model.info)
            model.compile()
            self.assert_error(mbd.ERR_ORDER, model.compile)
            self.assert_error(mbd.ERR_ORDER, model.add_pipes, 1)

    def test_sim_errors(self):
        rig = Rig()
        self.assert_error(mbd.ERR_VALUE, rig.model.sim, spectral_radius=2.0)
        with rig.model.sim() as sim:
            before = sim.hash()
            self.assertIn("duration", self.assert_error(mbd.ERR_VALUE, sim.step, 0.0).message)
            self.assert_error(mbd.ERR_NOT_FINITE, sim.step, math.nan)
            self.assert_error(mbd.ERR_VALUE, sim.advance, -1.0)
            self.assert_error(mbd.ERR_ID, sim.pose, mbd.station(rig.feed))
            self.assert_error(mbd.ERR_ID, sim.drive, mbd.Id())
            self.assert_error(mbd.ERR_VALUE, sim.pose, mbd.station(rig.string, 99, 0.0))
            self.assert_error(mbd.ERR_UNSUPPORTED, sim.set_drive, rig.feed, 1.0)
            self.assert_error(mbd.ERR_VALUE, sim.restore, b"nothing")
            self.assert_error(mbd.ERR_VALUE, sim.contact, 10**6)
            self.assertEqual(sim.hash(), before)

    def test_closed_objects(self):
        rig = Rig()
        sim = rig.model.sim()
        sim.close()
        sim.close()
        self.assert_error(mbd.ERR_HANDLE, sim.step, 1e-3)
        self.assert_error(mbd.ERR_HANDLE, lambda: sim.time)
        rig.model.close()
        rig.model.close()
        self.assert_error(mbd.ERR_HANDLE, rig.model.sim)

    def test_wrong_types(self):
        with mbd.Model() as model:
            with self.assertRaises(TypeError):
                model.add_wall(mbd.PipeDef())
            with self.assertRaises(TypeError):
                model.add_wall(mbd.WallDef(), diameter=0.1)


class CallbackTest(unittest.TestCase):
    def build(self, *segments):
        model = mbd.Model()
        string = model.add_pipes(2)
        drive = model.add_drive(part=string, time_function=model.add_time_function(*segments))
        model.compile()
        return model, drive

    def test_function_of_time(self):
        model, drive = self.build(lambda time: 2.0 * time)
        with model.sim() as sim:
            sim.step(0.01)
            self.assertAlmostEqual(sim.drive(drive).speed, 0.02)

    def test_with_rate_and_integral(self):
        term = mbd.Segment(function=lambda t: (t, 1.0, 0.5 * t * t),
                        provides=mbd.PROVIDES_RATE | mbd.PROVIDES_INTEGRAL)
        model, drive = self.build(term)
        with model.sim() as sim:
            for _ in range(10):
                sim.step(1e-2)
            self.assertAlmostEqual(sim.drive(drive).position, 0.005, places=9)

    def test_exception_stops_the_step_and_comes_out(self):
        def time_function(time):
            if time > 0.0045:
                raise ZeroDivisionError("on purpose")
            return 1.0

        model, _ = self.build(time_function)
        with model.sim() as sim:
            for _ in range(4):
                sim.step(1e-3)
            assert_step_fails(self, sim)

    def test_wrong_values_returned(self):
        for returned in (math.nan, math.inf, None, "text"):
            model, _ = self.build(lambda time, returned=returned: returned if time > 0.0015 else 0.0)
            with model.sim() as sim:
                sim.step(1e-3)
                with self.assertRaises(mbd.Error) as caught:
                    sim.step(1e-3)
                self.assertEqual(caught.exception.status, mbd.ERR_CALLBACK)

    def test_keyboard_interrupt_is_not_wrapped(self):
        def time_function(time):
            if time > 0.0005:
                raise KeyboardInterrupt
            return 0.0

        model, _ = self.build(time_function)
        with model.sim() as sim, self.assertRaises(KeyboardInterrupt):
            sim.step(1e-3)


# ---- Forces by functions ------------------------------------------------------------------------------------------------
class ForceTest(unittest.TestCase):
    """A ball on a spring to the ground: the spring of the library, and the same by a function."""

    def ball(self, function=None, provides=0, **spring):
        model = mbd.Model()
        ball = model.add_body(position=(0.7, 0.2, 0), mass=2.0)
        if function is None:
            model.add_spring(place_b=mbd.station(ball), **spring)
        else:
            model.add_force(places=[ball], function=function, provides=provides)
        model.compile()
        return model.sim(newton_tolerance=1e-12, max_iterations=40), ball

    @staticmethod
    def spring(time, poses, velocities):
        x, v = poses[0][:3], velocities[0][:3]
        length = math.sqrt(sum(one * one for one in x))
        tension = 300.0 * (length - 0.5) + 4.0 * sum(a * b for a, b in zip(x, v)) / length
        return [-tension * one / length for one in x] + [0.0] * 3, 150.0 * (length - 0.5) ** 2

    def test_as_the_spring_of_the_library(self):
        known, ball = self.ball(stiffness=300.0, damping=4.0, free_length=0.5)
        found, other = self.ball(self.spring, mbd.PROVIDES_POTENTIAL)
        with known, found:
            for _ in range(300):
                known.step(1e-3)
                found.step(1e-3)
            for a, b in zip(known.pose(mbd.station(ball)).position, found.pose(mbd.station(other)).position):
                self.assertAlmostEqual(a, b, 9)
            self.assertAlmostEqual(known.energy().strain, found.energy().strain, 8)

    def test_friction_with_a_state(self):
        stiffness, told = 1e4, []

        def bristles(at, state, step):
            if math.isinf(step):
                raise ValueError("no statics with slip here")
            x = state[0] + 0.5 * step * (at.slip_before[0] + at.slip[0])
            most = at.mu_dynamic / stiffness
            z, inside = max(-most, min(most, x)), abs(x) < most
            q = stiffness * z
            by_slip = [-at.normal_force * stiffness * 0.5 * step * inside, 0.0, 0.0, 0.0]
            return [-at.normal_force * q, 0.0], by_slip, [-q, 0.0], [z]

        ends = []
        for own in (True, False):
            model = mbd.Model()
            law = {"friction": bristles, "friction_state_count": 1, "friction_accept": lambda *what: told.append(what)}
            model.add_wall(mu_static=0.3, mu_dynamic=0.3, bristle_stiffness=stiffness,
                           **(law if own else {"friction_law": mbd.FRICTION_BRISTLE}))
            body = model.add_body(mass=10.0, contact_diameter=0.074, position=[1.0, 0.0, -0.01001], velocity=[0.2, 0, 0, 0, 0, 0],
                                  free_mask=mbd.FREE_X | mbd.FREE_Z)
            model.compile()
            with model.sim() as sim:
                sim.steps(1e-3, 100)
                ends.append(sim.pose(mbd.station(body)).position[0])
        self.assertAlmostEqual(ends[0], ends[1], 12)
        self.assertTrue(0.0 < max(what[2][0] for what in told) <= 0.3 / stiffness)
        self.assertNotIn("callback", words_of(mbd.FrictionLaw))

    def test_errors_in_laws_with_a_state(self):
        """An exception of accept comes out of the call, whose steps are done; a result of the wrong length says so."""
        shape: list = []

        def law(_time, _poses, _velocities, state, _step):
            return ([0.0] * 6, state) if not shape else shape[0]

        def accept(time, _number, _state):
            if 0.0015 < time < 0.0035:
                raise KeyError(f"at {1e3 * time:.0f} ms")

        model = mbd.Model()
        model.add_force(places=[model.add_body(mass=2.0)], function=law, state_count=1, accept=accept)
        model.compile()
        with model.sim() as sim:
            sim.steps(1e-3, 1)
            with self.assertRaisesRegex(KeyError, "at 2 ms"):
                sim.steps(1e-3, 4)
            self.assertAlmostEqual(sim.time, 5e-3, 12)
            sim.steps(1e-3, 1)
        with model.sim() as sim:  # the function of accepted steps raises too: its exception comes out, and only once
            sim.on_step = lambda time: 1.0 / (time < 0.0015) > 2.0
            with self.assertRaises(ZeroDivisionError):
                sim.steps(1e-3, 4)
            sim.on_step = None
            sim.steps(2e-3, 1)
            for wrong in ([0.0] * 6, ([0.0] * 6, [0.0], [0.0])):
                shape[:] = [wrong]
                with self.assertRaises(mbd.Error) as caught:
                    sim.step(1e-3)
                self.assertRegex(str(caught.exception.__cause__), "must be a tuple of 2: force, state")
        for states, wrong in ((0, ([0.0] * 2, [0.0] * 4, [0.0] * 2, [])), (1, ([0.0] * 2, [0.0] * 4, [0.0] * 2))):
            model = mbd.Model()
            model.add_wall(friction=lambda *_, wrong=wrong: wrong, friction_state_count=states)
            model.add_body(mass=10.0, contact_diameter=0.074, position=[1.0, 0.0, -0.01001], velocity=[0.2, 0, 0, 0, 0, 0],
                           free_mask=mbd.FREE_X | mbd.FREE_Z)
            model.compile()
            with self.assertRaises(mbd.Error) as caught, model.sim() as sim:
                sim.step(1e-3)
            self.assertRegex(str(caught.exception.__cause__), "force, by_slip, by_normal" + (", state" if states else ""))

    def test_law_with_a_state(self):
        told, k, limit = [], 2000.0, 30.0

        def slider(time, poses, velocities, state, step):
            x, (s, before) = poses[0][2], state
            s = max(-limit / k, min(limit / k, s + x - before))
            return [0.0, 0.0, -k * s, 0.0, 0.0, 0.0], [s, x]

        model = mbd.Model()
        body = model.add_body(mass=2.0, velocity=[0.0, 0.0, 1.0, 0.0, 0.0, 0.0])
        model.set_environment(gravity=[0.0, 0.0, 0.0])
        model.add_force(places=[body], function=slider, state_count=2, accept=lambda *what: told.append(what))
        model.compile()
        with model.sim() as sim:
            sim.steps(1e-3, 50)
            saved, number = sim.snapshot(), sim.hash()
            sim.steps(1e-3, 50)
            end = sim.hash()
            sim.restore(saved)
            self.assertEqual(sim.hash(), number)
            sim.steps(1e-3, 50)
            self.assertEqual(sim.hash(), end)
            self.assertEqual(len(told), 150)
            self.assertEqual(told[-1][:2], (sim.time, 0))
            self.assertAlmostEqual(told[-1][2][1], sim.pose(mbd.station(body)).position[2], 12)

    def test_function_that_raises(self):
        calls = []

        def force(time, poses, velocities):
            if time > 0.0015:
                raise ZeroDivisionError("on purpose")
            calls.append(time)
            return [0.0] * 6
        sim, _ = self.ball(force)
        with sim:
            sim.step(1e-3)
            assert_step_fails(self, sim)
            self.assertTrue(calls)

    def test_wrong_values_returned(self):
        for returned in ([0.0] * 5, [math.nan] * 6, None, "text"):
            with self.assertRaises(mbd.Error) as caught:
                sim, _ = self.ball(lambda time, poses, velocities, returned=returned: returned)
                with sim:
                    sim.step(1e-3)
            self.assertEqual(caught.exception.status, mbd.ERR_CALLBACK)


# ---- Progress --------------------------------------------------------------------------------------------------------
class AssemblyTest(unittest.TestCase):
    """Of a bottom-hole assembly: a stuck place, and a mud motor."""

    def test_stuck(self):
        model = mbd.Model()
        model.set_environment(gravity=(1.0, 0, 0))
        ball = model.add_body(mass=2.0)
        jam = model.add_stuck(place=ball, name="jam", stiffness=(1e3, 1e3, 1e3), overpull=100.0)
        model.add_input(name="jammed", target=mbd.TARGET_STUCK, part=jam)
        model.compile()
        with model.sim() as sim:
            sim.step(1e-3)
            state = sim.stuck(jam)
            self.assertEqual(state.stuck, 1)
            self.assertLess(state.force[0], 0.0)  # against the weight
            sim.inputs["jammed"] = 0.0
            self.assertEqual(sim.stuck(jam).stuck, 0)
            with self.assertRaises(mbd.Error):
                sim.inputs["jammed"] = 0.5

    def test_motor(self):
        drive, speed = mbd.motor_drive(stall_torque=900.0, displacement=0.012, flow=0.015)
        self.assertAlmostEqual(speed, 2.0 * math.pi * 0.015 / 0.012)
        self.assertAlmostEqual(drive.gain * speed, 900.0)
        self.assertEqual((drive.limit_low, drive.limit_high), (0.0, 900.0))
        with self.assertRaises(mbd.Error):
            mbd.motor_drive(stall_torque=-1.0, displacement=0.012, flow=0.015)


class ProgressTest(unittest.TestCase):
    def test_told(self):
        rig, fractions = Rig(), []
        with rig.model.sim() as sim:
            sim.on_progress = fractions.append  # None: goes on
            self.assertEqual(sim.advance(0.02).status, mbd.OK)
            self.assertGreater(len(fractions), 3)
            self.assertEqual(fractions, sorted(fractions))
            sim.on_progress = None
            told = len(fractions)
            sim.step(1e-3)
            self.assertEqual(len(fractions), told)

    def test_cancel(self):
        rig = Rig()
        with rig.model.sim() as sim:
            sim.on_progress = lambda fraction: fraction > 0.5
            report = sim.advance(1.0)
            self.assertEqual(report.status, mbd.NOTE_CANCELLED)
            self.assertTrue(0.5 < sim.time < 1.0)
            before = sim.hash()
            sim.on_progress = lambda fraction: True
            for call in (sim.static, sim.modes, lambda: sim.step(1e-3)):
                with self.assertRaises(mbd.Error) as caught:
                    call()
                self.assertEqual(caught.exception.status, mbd.ERR_CANCELLED)
                self.assertEqual(sim.hash(), before)

    def test_exceptions_pass(self):
        rig = Rig()
        with rig.model.sim() as sim:
            def told(_fraction):
                raise LookupError("enough")
            sim.on_progress = told
            for call in (sim.static, lambda: sim.advance(1.0)):
                with self.assertRaisesRegex(LookupError, "enough"):
                    call()
            sim.on_progress = None
            sim.advance(1e-3)

    def test_interrupt(self):
        rig = Rig()
        with rig.model.sim() as sim:
            for told in (None, lambda fraction: False):
                sim.on_progress = told
                timer = threading.Timer(0.05, os.kill, (os.getpid(), signal.SIGINT))
                timer.start()
                with self.assertRaises(KeyboardInterrupt):
                    sim.advance(sim.time + 1e6)
                timer.join()
                self.assertIs(signal.getsignal(signal.SIGINT), signal.default_int_handler)
            sim.on_progress = None
            self.assertEqual(sim.step(1e-3).status, mbd.OK)


# ---- Who goes first --------------------------------------------------------------------------------------------------
class LifetimeTest(unittest.TestCase):
    def test_sim_outlives_its_model(self):
        rig = Rig()
        sim, tip = rig.model.sim(), rig.tip
        del rig
        gc.collect()
        sim.step(1e-3)
        self.assertTrue(math.isfinite(sim.pose(tip).position[0]))

    def test_callback_lives_as_long_as_the_sim(self):
        def build():
            model = mbd.Model()
            drive = model.add_drive(part=model.add_pipes(1), time_function=model.add_time_function(lambda time: 0.1))
            model.compile()
            return model.sim(), drive

        sim, drive = build()
        gc.collect()
        for _ in range(5):
            sim.step(1e-3)
        self.assertAlmostEqual(sim.drive(drive).speed, 0.1)

    def test_callback_goes_with_the_last_sim(self):
        class Function:
            def __call__(self, time):
                return 0.0

        function = Function()
        watched = weakref.ref(function)
        model = mbd.Model()
        model.add_drive(part=model.add_pipes(1), time_function=model.add_time_function(function))
        model.compile()
        sims = [model.sim(), model.sim()]
        del function, model
        gc.collect()
        self.assertIsNotNone(watched())
        del sims
        gc.collect()
        self.assertIsNone(watched())

    def test_objects_go_in_any_order(self):
        for order in ((0, 1, 2), (2, 1, 0), (1, 0, 2), (1, 2, 0), (2, 0, 1), (0, 2, 1)):
            rig = Rig(2)
            first, second = rig.model.sim(), rig.model.sim()
            objects = [rig, first, second]
            del rig, first, second
            for i in order:
                objects[i] = None
                gc.collect()

    def test_recorder_keeps_its_sim(self):
        rig = Rig(2)
        recorder = rig.model.sim().recorder([(rig.tip, mbd.OUTPUT_POSITION_X)], capacity=2)
        del rig
        gc.collect()
        self.assertEqual(recorder.take(), mbd.OK)
        self.assertAlmostEqual(float(recorder.table[0][1]), 2.0)

    def test_unfinished_objects_are_harmless(self):
        self.assertRaises(mbd.Error, mbd.Model().sim)
        with self.assertRaises(AttributeError):
            mbd.Model().sim(nonsense=1)
        gc.collect()


if __name__ == "__main__":
    unittest.main()
