"""Tests of the package around the interface: documentation and types of all names, made files up to date, errors taken
apart, models that copy and pickle, runs with progress and Ctrl-C, arrays, frames and pictures."""
import copy
import gc
import inspect
import math
import os
import pathlib
import pickle
import resource
import signal
import subprocess
import sys
import tempfile
import threading
import unittest

import drillmbd as mbd
from drillmbd import _optional

HERE = pathlib.Path(__file__).resolve().parent


def there(*names):
    """Whether optional packages are there; the test says which it skips for."""
    missing = []
    for name in names:
        try:
            _optional.need(name)
        except ImportError:
            missing.append(name)
    return unittest.skipIf(missing, f"not there: {', '.join(missing)}")


def ramp(time):
    """A time function that pickles: a function of a module."""
    return 0.05 * min(time / 0.02, 1.0)


def full_model():
    """Every kind of part but a Python constraint."""
    model = mbd.Model()
    model.set_environment(fluid_density=1000.0)
    model.add_wall(stations=[(0, math.pi / 2, 0), (10, math.pi / 2, 0), (40, 1.6, 0.05)])
    string = model.add_string(start_free=mbd.FREE_CYLINDRICAL)
    model.add_pipes(2, string=string, kind=mbd.PIPE_RIGID)
    model.add_pipes(2, mbd.PipeDef(string=string, joint_length=0.1, eccentricity=1e-3))
    body = model.add_body(mass=2.0, position=(5, 0, 0.5))
    load = model.add_time_function(mbd.Segment(kind=mbd.SEGMENT_HARMONIC, h1=1.0, omega=30.0), 0.5,
                               mbd.Segment(table=([0.0, 0.01], [0.0, 1.0])))
    model.add_bit(rock_law=mbd.ROCK_RATE, load=load)
    model.add_load(place=mbd.station(body), force=(10, 0, 0), time_function=load)
    hinge = model.add_joint(kind=mbd.JOINT_REVOLUTE, name="hinge", place_b=body, origin_a=(5, 0, 1), axis_a=(0, 1, 0),
                            match=1)
    model.add_drive(part=hinge, component=mbd.RX, kind=mbd.DRIVE_LOAD, time_function=load)
    feed = model.add_drive(time_function=model.add_time_function(ramp))
    model.compile(features=mbd.FEATURE_ALL & ~mbd.FEATURE_EXCITATION)
    return model, string, feed


def hash_after(model, steps=5):
    with model.sim() as sim:
        for _ in range(steps):
            sim.step(1e-3)
        return sim.hash()


class NamesTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(folder.cleanup)
        cls.cache = folder.name

    def check_types(self, path):
        """Output of mypy, with one cache of the package for all calls."""
        return subprocess.run([sys.executable, "-m", "mypy", "--strict", "--cache-dir", self.cache, path],
                              capture_output=True, text=True, env={**os.environ, "MYPYPATH": str(HERE)})

    def test_made_files_are_what_the_headers_say(self):
        done = subprocess.run([sys.executable, HERE / "generate.py", "--check"], capture_output=True, text=True)
        self.assertEqual(done.returncode, 0, done.stdout)

    def test_all_names_are_there_and_documented(self):
        for name in mbd.__all__:
            value = getattr(mbd, name)
            if inspect.isclass(value) and not name.endswith("_FN"):
                self.assertTrue(value.__doc__, name)
                for member, method in vars(value).items():
                    if inspect.isfunction(method) and not member.startswith("_"):
                        self.assertTrue(method.__doc__, f"{name}.{member}")
            elif inspect.isfunction(value):
                self.assertTrue(value.__doc__, name)

    def test_each_name_has_a_docstring(self):
        """Constants by their own sentence where the headers have one, outputs by their unit, structs by what they are
        for, each public method and property of all classes."""
        for name in mbd.__all__:
            self.assertTrue(getattr(mbd, name).__doc__, name)
            if inspect.isclass(getattr(mbd, name)):
                for member in dir(getattr(mbd, name)):
                    static = inspect.getattr_static(getattr(mbd, name), member)
                    if not member.startswith("_") and (inspect.isfunction(static) or isinstance(static, property)):
                        self.assertTrue(inspect.getdoc(static), f"{name}.{member}")
        self.assertEqual(mbd.FRICTION_BRISTLE.__doc__,
                         "elastic bristle that sticks; breaks away at mu_static, one step late (order 1)")
        self.assertTrue(mbd.OUTPUT_VELOCITY_X.__doc__.startswith("[m/s]"))
        self.assertIn("STRIBECK: mu_d", mbd.FrictionLaw.__doc__)
        self.assertIn("output (Output)", mbd.EventDef.__doc__)
        self.assertIn("dmb_model_add_pipes", mbd.PipeDef.__doc__)
        self.assertNotIn("reserved", mbd.DriveDef.__doc__)
        self.assertNotIn("reserved", repr(mbd.DriveDef()))

    def test_fields_tell_unit_and_meaning(self):
        for struct in mbd.STRUCTS.values():
            if issubclass(struct, mbd._Sized):
                self.assertIn(struct.c_name, struct.__doc__)
        self.assertEqual(mbd.WallDef.field_docs["stiffness"][0], "N/m^(n+1)")
        self.assertIn("diameter: [m] of the hole, > 0; default 0.094", mbd.WallDef.__doc__)

    def test_constants_are_enumerations(self):
        self.assertIs(mbd.JOINT_REVOLUTE, mbd.JointKind.REVOLUTE)
        self.assertEqual(mbd.FREE_X | mbd.FREE_RX, mbd.FREE_CYLINDRICAL)
        self.assertEqual(mbd.Status(-5), mbd.ERR_VALUE)
        self.assertEqual(mbd.Quantity.BIT_WEIGHT, mbd.OUTPUT_BIT_WEIGHT)

    def test_version(self):
        self.assertEqual(mbd.__version__, ".".join(map(str, mbd.VERSION)))
        self.assertEqual(mbd._lib.dmb_version(), sum(n * f for n, f in zip(mbd.VERSION, (10000, 100, 1))))

    def test_types(self):
        try:
            import mypy  # noqa: F401
        except ImportError:
            self.skipTest("not there: mypy")
        done = self.check_types(HERE / "drillmbd")
        self.assertEqual(done.returncode, 0, done.stdout)

    def test_types_of_a_users_program(self):
        """A right program passes the strictest check; a misspelt field and a text for a number are found by it."""
        try:
            import mypy  # noqa: F401
        except ImportError:
            self.skipTest("not there: mypy")
        right = (HERE.parents[1] / "examples"
                 / "README.md").read_text(encoding="utf-8").split("```python\n")[1].split("```")[0]
        right += ('definition = mbd.PipeDef(length=3, name="rods", kind=mbd.PIPE_FLEXIBLE, curvature=(0.0, 0.0, '
                  '0.01))\n'
                  "frame, force = sim.profile(string, 30).frame(), sim.drive(table).force + 1.0\n"
                  "done = sim.run(2.1, step=1e-3, progress=lambda at: at.fraction > 0.5)\n")
        right += ('sim.set_drive(table, 1.0)\nsim.set_drive("table", 1.0)\nspeed = sim.drive(model["table"]).speed\n'
                  "again = mbd.Model()\nagain.add_pipes(3, "
                  "mbd.PipeDef(length=3))\nagain.compile(pipe_kind=mbd.PIPE_RIGID)\n"
                  "found = again.sim(newton_tolerance=1e-8).modes(count=3)\n")
        wrong = ('mbd.PipeDef(lenght=3.0)\nmbd.PipeDef(length="3")\nsim.step("1")\nmbd.DriveDef(part="rods")\n'
                 "again.add_pipes(3, outer_diamter=0.07)\nagain.sim(newton_tolerence=1e-8)\nsim.static(load_step=3)\n"
                 "sim.set_drive(string, 1.0)\nagain.add_drive(part=string, time_functoin=string)\n")
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder, "program.py")
            for text, errors in ((right, 0), (right + wrong, 9)):
                path.write_text(text, encoding="utf-8")
                done = self.check_types(path)
                self.assertEqual(done.stdout.count(": error:"), errors, done.stdout)
        self.assertIn('did you mean "length"', done.stdout)

    def test_library_that_is_not_there_or_no_library(self):
        for name in ("/nonexistent/libdrillmbd.so", __file__):
            done = subprocess.run([sys.executable, "-c", "import drillmbd"], capture_output=True, text=True,
                                  env={**os.environ, "DRILLMBD_LIBRARY": name, "PYTHONPATH": str(HERE)})
            self.assertIn("ImportError", done.stderr)
            self.assertIn(name, done.stderr)


class ErrorPartsTest(unittest.TestCase):
    def caught(self, function, *arguments, **fields):
        with self.assertRaises(mbd.Error) as caught:
            function(*arguments, **fields)
        return caught.exception

    def test_parts_of_a_message(self):
        model = mbd.Model()
        error = self.caught(model.add_wall, diameter=-0.5)
        self.assertEqual((error.status, error.part, error.field, error.value),
                         (mbd.ERR_VALUE, "wall", "diameter", -0.5))
        self.assertTrue(error.bound)
        body = model.add_body()
        error = self.caught(model.add_joint, name="crank", place_b=body, axis_a=(0, 0, 0))
        self.assertEqual((error.part, error.field, error.value), ("joint 0 (crank)", "axis_a", 0.0))
        self.assertEqual(error.bound, "be of length > 0")

    def test_message_without_parts(self):
        error = mbd.Error(mbd.ERR_NULL)
        self.assertEqual((error.part, error.field, error.value, error.bound), (None, None, None, None))
        self.assertTrue(error.message)

    def test_advice(self):
        error = mbd.Error(-5, "pipe 3: length = 0 m, must be > 0 m; leave it out")
        self.assertEqual((error.field, error.value, error.bound, error.advice),
                         ("length", 0.0, "be > 0 m", "leave it out"))

    def test_errors_pickle(self):
        error = pickle.loads(pickle.dumps(self.caught(mbd.Model().add_wall, diameter=-0.5)))
        self.assertEqual((error.status, error.field), (mbd.ERR_VALUE, "diameter"))


class DescriptionTest(unittest.TestCase):
    def test_structs_copy_compare_and_pickle(self):
        for made in (mbd.PipeDef(length=2.0, curvature=(1, 2, 3)), mbd.Segment(table=[(0, 1), (2, 5)]),
                     mbd.WallDef(stations=[(0, 1.5, 0), (30, 1.6, 0.1)]), mbd.Segment(function=ramp),
                     mbd.JointDef(name="hinge"), mbd.station(mbd.Id(1, 2), 3, 0.5), mbd.Id(3, 4)):
            for other in (copy.copy(made), copy.deepcopy(made), pickle.loads(pickle.dumps(made))):
                self.assertEqual(other, made)
        self.assertNotEqual(mbd.PipeDef(), mbd.PipeDef(length=2.0))
        self.assertNotEqual(mbd.Segment(table=[(0, 1), (2, 5)]), mbd.Segment(table=[(0, 1), (2, 6)]))

    def test_table_as_pairs_or_columns(self):
        pairs = mbd.Segment(table=[(0, 1), (2, 5)])
        self.assertEqual(mbd.Segment(table=([0, 2], [1, 5])), pairs)
        self.assertEqual(mbd.Segment(table=((0, 1), (2, 5))), pairs)
        if mbd.numpy is not None:
            times, values = mbd.numpy.array([0.0, 2.0]), mbd.numpy.array([1.0, 5.0])
            self.assertEqual(mbd.Segment(table=(times, values)), pairs)
            self.assertEqual(mbd.Segment(table=mbd.numpy.array([[0.0, 1.0], [2.0, 5.0]])), pairs)
        with self.assertRaises(ValueError):
            mbd.Segment(table=([0, 1, 2], [1, 5]))

    def test_models_copy_and_pickle(self):
        model, string, feed = full_model()
        expected = hash_after(model)
        for other in (copy.copy(model), copy.deepcopy(model), pickle.loads(pickle.dumps(model))):
            self.assertTrue(other.same_scene(model))
            self.assertEqual(hash_after(other), expected)
            with other.sim() as sim:
                sim.step(1e-3)
                self.assertGreater(sim.drive(other.own(feed)).speed, 0.0)
                self.assertGreater(sim.pose(other.own(mbd.station(string, 3, 1.0))).depth, 3.0)
                with self.assertRaises(mbd.Error):
                    sim.drive(feed)  # the id of another model
        different = mbd.Model()
        different.add_pipes(3)
        self.assertFalse(different.same_scene(model))

    def test_names(self):
        model = mbd.Model()
        string = model.add_pipes(5, name="drill pipe")
        model.add_pipes(2, name="collars", outer_diameter=0.12)
        head = model.add_body(name="rotary head")
        turn = model.add_time_function(12.0)
        rotation = model.add_drive(part=string, component=mbd.RX, time_function=turn, name="rotation")
        setting = model.add_input(name="rotation", part=rotation, rate_limit=1.0)
        model.set_name(string, "main")
        model.set_name(turn, "12 rad/s")
        copied = copy.copy(model)
        for one in (model, copied):
            self.assertEqual(one["rotary head"], one.own(head))
            self.assertEqual(one["main"], one.own(string))
            self.assertEqual(one["12 rad/s"], one.own(turn))
            self.assertEqual(one.find("rotation", mbd.PartKind.INPUT), one.own(setting))
            self.assertEqual(one.find_pipes("collars"), (one.own(string), range(5, 7)))
            self.assertEqual(one.name_of(one.own(string)), "main")
            self.assertTrue("rotation" in one and "main" in one and "nobody" not in one)
            for name in ("rotation", "nobody"):
                with self.assertRaisesRegex(KeyError, name):
                    one[name]
            with self.assertRaises(KeyError):
                one.find_pipes("nobody")
        self.assertTrue(copied.same_scene(model))
        with self.assertRaisesRegex(mbd.Error, "body 0 has it"):
            model.add_body(name="rotary head")

    def test_failed_calls_are_not_described(self):
        model = mbd.Model()
        with self.assertRaises(mbd.Error):
            model.add_wall(diameter=-1.0)
        self.assertEqual(model.calls, [])

    def test_lambda_does_not_pickle(self):
        model = mbd.Model()
        model.add_time_function(lambda time: time)
        with self.assertRaises((pickle.PicklingError, AttributeError)):
            pickle.dumps(model)

    def test_sim_says_how_it_is_kept(self):
        model, _, _ = full_model()
        with model.sim() as sim, self.assertRaisesRegex(TypeError, "snapshot"):
            pickle.dumps(sim)


class RunTest(unittest.TestCase):
    def setUp(self):
        self.model = mbd.Model()
        self.string = self.model.add_pipes(3)
        self.model.add_drive(time_function=self.model.add_time_function(0.01))
        self.model.compile()
        self.sim = self.model.sim()

    def test_equal_steps(self):
        by_hand = self.model.sim()
        for _ in range(20):
            by_hand.step(1e-3)
        done = self.sim.run(0.02, step=1e-3)
        self.assertEqual(done.steps, 20)
        self.assertAlmostEqual(self.sim.time, 0.02)
        self.assertAlmostEqual(self.sim.pose(mbd.station(self.string)).displacement[0],
                               by_hand.pose(mbd.station(self.string)).displacement[0])

    def test_last_step_is_shorter(self):
        self.sim.run(0.0025, step=1e-3)
        self.assertEqual(self.sim.time, 0.0025)
        self.assertEqual(self.sim.statistics().steps, 3)

    def test_steps_of_its_own(self):
        self.assertEqual(self.sim.run(0.05).fraction, 1.0)
        self.assertEqual(self.sim.time, 0.05)
        self.assertEqual(self.sim.run(0.05).steps, 0)

    def test_bounded_advances_go_on(self):
        with self.model.sim(max_steps=2, step_max=1e-4) as sim:
            sim.run(0.01)
            self.assertEqual(sim.time, 0.01)

    def test_progress_stops(self):
        seen = []

        def progress(at):
            seen.append(at)
            return at.time > 0.005

        done = self.sim.run(0.1, step=1e-3, progress=progress, every=0.0)
        self.assertAlmostEqual(done.time, 0.006)
        self.assertEqual([at.steps for at in seen], list(range(1, 7)))
        self.assertGreater(seen[-1].real_time_factor, 0.0)

    def test_sub(self):
        """A body in the middle of a string: the same scene by the C call, as a copy of its parts, and typed by hand."""
        def scene(by_sub):
            model = mbd.Model()
            string = model.add_string(follows_hole=0)
            model.add_pipes(2, string=string, length=1.5)
            collar, knuckle = mbd.BodyDef(mass=20.0), mbd.JointDef(kind=mbd.JOINT_SPHERICAL)
            if by_sub:
                made = model.add_sub(string, 0.3, body=collar, after=knuckle)
                self.assertEqual((collar.position[0], knuckle.match), (0.0, 0))
                body, section = made.body, made.section
            else:
                body = model.add_body(mass=20.0, position=(3.0, 0.0, 0.0))
                section = model.add_string(follows_hole=0, position=(3.3, 0.0, 0.0), start_free=mbd.FREE_ALL)
                model.add_joint(place_a=mbd.station(string, 1, 1.0), place_b=mbd.station(body), match=1)
                model.add_joint(kind=mbd.JOINT_SPHERICAL, place_a=mbd.station(body), place_b=mbd.station(section),
                                origin_a=(0.3, 0.0, 0.0), match=1)
            model.add_pipes(2, string=section, length=1.5)
            model.compile()
            return model
        model = scene(True)
        hashes = []
        for one in (model, copy.copy(model), scene(False)):
            sim = one.sim()
            for _ in range(20):
                sim.step(1e-3)
            hashes.append(sim.hash())
        self.assertEqual(hashes, hashes[:1] * 3)

    def test_recorder_in_a_run(self):
        recorder = self.sim.recorder([(self.string, mbd.OUTPUT_POSITION_X, "rig end [m]")], capacity=100)
        self.sim.run(0.01, step=1e-3, recorder=recorder)
        self.assertEqual(len(recorder), 11)
        self.assertEqual(recorder.columns, ["time [s]", "rig end [m]"])

    def test_interrupt_leaves_what_is_done(self):
        recorder = self.sim.recorder([(self.string, mbd.OUTPUT_POSITION_X)], capacity=10 ** 6)
        threading.Timer(0.2, lambda: os.kill(os.getpid(), signal.SIGINT)).start()
        with self.assertRaises(KeyboardInterrupt):
            self.sim.run(1e3, step=1e-3, recorder=recorder)
        self.assertGreater(len(recorder), 1)
        reached = self.sim.time
        self.sim.step(1e-3)
        self.assertGreater(self.sim.time, reached)

    def test_interrupt_in_functions(self):
        """Ctrl-C as a Python function begins was lost: the step failed with ERR_CALLBACK, or went on."""
        model = mbd.Model()
        body = model.add_body(mass=1.0)
        model.add_load(place=body, force=(1, 0, 0), time_function=model.add_time_function(*[lambda time: 0.1] * 20))
        model.compile()
        for _ in range(15):
            with model.sim(energy_ledger=0) as sim:
                timer = threading.Timer(0.02, lambda: os.kill(os.getpid(), signal.SIGINT))
                timer.start()
                with self.assertRaises(KeyboardInterrupt):
                    sim.run(1e3, step=1e-3)
                reached = sim.time
                sim.step(1e-3)
                self.assertGreater(sim.time, reached)
                timer.join()
        self.assertIs(signal.getsignal(signal.SIGINT), signal.default_int_handler)

    @there("numpy")
    def test_table_shares_memory(self):
        recorder = self.sim.recorder([(self.string, mbd.OUTPUT_POSITION_X)], capacity=5)
        recorder.take()
        table = recorder.table
        self.assertTrue(mbd.numpy.shares_memory(table, recorder._memory))
        del recorder
        gc.collect()
        self.assertEqual(table.shape, (1, 2))


class ArraysTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.model = mbd.Model()
        cls.model.add_wall(diameter=0.094)
        cls.string = cls.model.add_string(start_free=mbd.FREE_NONE)
        cls.model.add_pipes(10, string=cls.string)
        cls.model.compile()
        cls.sim = cls.model.sim()
        cls.sim.static()
        cls.places = [mbd.station(cls.string, i, 1.0) for i in range(10)]

    @there("numpy")
    def test_profile(self):
        found = self.sim.profile(self.string, 10)
        self.assertEqual(found.position.shape, (21, 3))
        self.assertEqual(found.force.shape, (21, 6))
        self.assertAlmostEqual(found.along[-1], 10.0, 3)
        self.assertAlmostEqual(found.contact_force.sum(), self.sim.contact_total().normal_force)
        with self.assertRaises(ValueError):
            self.sim.profile(self.string, 10, 0)
        self.assertEqual(found["deviation"][7], found[mbd.PROFILE_DEVIATION][7])
        self.assertEqual(found.force[6, 0], self.sim.section(mbd.station(self.string, 3, 0.0)).force[0])
        with self.assertRaises(KeyError):
            found["deviations"]
        self.assertAlmostEqual(self.model.hole(5.0).diameter, 0.094)
        self.assertEqual(self.model.hole(5.0).dogleg_severity, 0.0)

    def test_sensitivity(self):
        strings = []

        def describe(damping):
            model = mbd.Model()
            model.set_environment(lateral_damping=damping)
            strings.append(model.add_pipes(3, elements=1))
            model.compile()
            return model

        made = mbd.sensitivity_of(describe, {"damping": 5.0}, steps={"damping": 0.01})
        runs = []
        for _ in range(20):
            self.assertEqual(made.step(1e-3).steps, 1)
        place = mbd.station(strings[-1], 2, 1.0)
        values, derivatives = made.outputs([(place, "position_z"), (place, "velocity_z")])
        for damping in (4.99, 5.01):
            sim = describe(damping).sim()
            for _ in range(20):
                sim.step(1e-3)
            runs.append(sim.output("velocity_z", mbd.station(strings[-1], 2, 1.0)))
        self.assertAlmostEqual(derivatives[1][0], (runs[1] - runs[0]) / 0.02,
                               delta=1e-6 * abs(derivatives[1][0]) + 1e-12)
        pose, velocity = made.rows("damping")
        self.assertEqual(len(pose), len(velocity))
        self.assertEqual(made.kinks("damping"), 0)
        made.advance(0.03)
        with self.assertRaises(mbd.Error):
            made.outputs([(place, "energy_error")])

    def test_on_step(self):
        model = mbd.Model()
        model.add_pipes(2, elements=1)
        model.compile()
        sim = model.sim()
        times = []
        sim.on_step = lambda time: times.append(time) or len(times) == 3
        self.assertEqual(sim.steps(1e-4, 5).status, mbd.NOTE_STOPPED)
        self.assertEqual([round(time, 12) for time in times], [1e-4, 2e-4, 3e-4])
        self.assertEqual(times[-1], sim.time)
        self.assertEqual(sim.step(1e-4).status, mbd.OK)

        def fails(_time):
            raise KeyError("mine")

        sim.on_step = fails
        with self.assertRaises(KeyError):
            sim.advance(1e-3)
        sim.on_step = None
        self.assertEqual(sim.advance(1e-3).status, mbd.OK)
        self.assertEqual(len(times), 4)

    def test_on_step_ends_a_run(self):
        model = mbd.Model()
        model.add_pipes(2, elements=1)
        model.compile()
        for step in (1e-5, None):  # many steps in a call, and steps of the library's choice
            for last in (1, 2, 50):
                sim = model.sim(step_max=1e-5)
                times = []
                sim.on_step = lambda time: times.append(time) or len(times) == last
                at = sim.run(1e-3, step=step)
                self.assertEqual((len(times), at.steps, at.time), (last, last, times[-1]))
                at = sim.run(1e-3, step=step)
                self.assertAlmostEqual(at.time, 1e-3, 12)
                self.assertEqual(times[-1], at.time)

    def test_state_equation(self):
        """By classical Runge-Kutta against the library's own steps."""
        model = mbd.Model()
        string = model.add_pipes(2, elements=1, damping_time=1e-5)
        model.add_load(place=mbd.station(string, 1, 1.0), force=[0.0, 30.0, 0.0])
        model.compile()
        sim = model.sim()
        before = sim.hash()
        equation = sim.state_equation()
        self.assertEqual(sim.hash(), before)
        self.assertEqual(len(equation.y), 2 * len(equation.rows))
        time, y, h = equation.time, equation.y, 1e-5
        for _ in range(100):
            first = equation(time, y)
            second = equation(time + h / 2, [a + h / 2 * b for a, b in zip(y, first)])
            third = equation(time + h / 2, [a + h / 2 * b for a, b in zip(y, second)])
            fourth = equation(time + h, [a + h * b for a, b in zip(y, third)])
            y = [a + h / 6 * (b + 2 * c + 2 * d + e) for a, b, c, d, e in zip(y, first, second, third, fourth)]
            time += h
            sim.step(h)
        place = mbd.station(string, 1, 1.0)
        there = equation.at(time, y)
        self.assertAlmostEqual(there.time, 1e-3)
        here = sim.output("velocity_y", place)
        self.assertAlmostEqual(there.output("velocity_y", place), here, delta=1e-3 * abs(here))
        self.assertEqual(equation.begin(time, y)[:3], [0.0, 0.0, 0.0])
        self.assertAlmostEqual(equation.time, 1e-3)
        with self.assertRaises(ValueError):
            equation(0.0, [1.0])
        with self.assertRaises(mbd.Error):
            equation(float("nan"), equation.y)

    def test_outputs(self):
        names = mbd.output_names()
        self.assertIn("hook_load", names)
        self.assertEqual(mbd.output_unit(mbd.output_quantity("bit_speed")), "rad/s")
        self.assertEqual(self.sim.output("axial_force", self.places[4]), self.sim.section(self.places[4]).force[0])
        self.assertEqual(self.sim.output("hook_load"), self.sim.section(mbd.station(self.string, 0, 0.0)).force[0])
        with self.assertRaises(mbd.Error) as raised:
            self.sim.output("joint_action_x", self.string)
        self.assertIn("must be a joint", str(raised.exception))
        with self.assertRaises(ValueError):
            mbd.output_quantity("hookload")
        window = self.sim.window([(None, "bit_speed")], length=1.0, levels=[0.1])
        recorder = self.sim.recorder([(0, "stick_slip_index"), (None, "stretch")], 4, window=window)
        rows = self.sim.profile_recorder([mbd.PROFILE_DISTANCE, mbd.PROFILE_TORQUE], 5, 3)
        window.take()
        recorder.take()
        rows.take()
        self.assertEqual(window.result().samples, 1)
        self.assertEqual(recorder.columns[1:], ["stick_slip_index of output 0 [-]", "stretch [m]"])
        self.assertEqual(rows.columns, ["distance [m]", "torque [N m]"])
        if mbd.numpy is not None:
            self.assertEqual(rows.values.shape, (1, 5, 2))
            self.assertAlmostEqual(rows.values[0, -1, 0], 10.0)
        window.reset()

    @there("scipy")
    def test_state_space(self):
        import numpy
        import scipy.linalg
        import scipy.sparse.linalg
        model = mbd.Model()
        model.set_environment(gravity=(0.0, 0.0, 0.0))
        string = model.add_string(start_free=mbd.FREE_CYLINDRICAL)
        model.add_pipes(8, string=string, damping_time=1e-3)
        feed = model.add_drive(part=string, kind=mbd.DRIVE_CONTROL, gain=2e4, integral_gain=1e6,
                               time_function=model.add_time_function(mbd.Segment()))
        model.add_drive(part=string, component=mbd.RX, time_function=model.add_time_function(mbd.Segment()))
        model.compile()
        sim = mbd.Sim(model)
        inputs = [mbd.Excitation(kind=mbd.EXCITATION_DRIVE, place=mbd.station(feed))]
        outputs = [(mbd.station(string, 7, 1.0), "vibration_x"),
                   (mbd.station(string), mbd.OUTPUT_HOOK_LOAD)]
        full = sim.state_space(inputs, outputs)
        A, B, C, D = full.matrices
        self.assertEqual(full.info.states, len(A))
        frequencies = [3.0, 40.0, 111.0]
        response = sim.response(inputs, outputs, frequencies=frequencies)
        for k in range(2):
            want = response.transfer(0, k)
            for i, f in enumerate(frequencies):
                got = (C @ numpy.linalg.solve(2j * numpy.pi * f * numpy.eye(len(A)) - A, B) + D)[k, 0]
                self.assertLess(abs(got - want[i]), 1e-8 * abs(want[i]))
        # a step of the target, by the matrix exponential and by a run; a ramp of 20 ms, its integral as the state
        rise, h, n = 0.02, 2e-4, 150
        x, block = numpy.zeros(len(A)), numpy.zeros((len(A) + 2, len(A) + 2))
        block[:len(A), :len(A)], block[:len(A), -2:-1], block[-2, -1] = A, B, 1.0
        step = scipy.linalg.expm(h * block)
        for i in range(n):
            u = min(i * h / rise, 1.0), 1.0 / rise if i * h < rise - 1e-9 else 0.0
            x = (step @ numpy.concatenate([x, u]))[:-2]
        moving = mbd.Model()
        moving.set_environment(gravity=(0.0, 0.0, 0.0))
        other = moving.add_string(start_free=mbd.FREE_CYLINDRICAL)
        moving.add_pipes(8, string=other, damping_time=1e-3)
        moving.add_drive(part=other, kind=mbd.DRIVE_CONTROL, gain=2e4, integral_gain=1e6,
                         time_function=moving.add_time_function(
            mbd.Segment(table=([0.0, rise], [0.0, 1e-4]))))
        moving.add_drive(part=other, component=mbd.RX, time_function=moving.add_time_function(mbd.Segment()))
        moving.compile()
        run = mbd.Sim(moving)
        for _ in range(n * 4):
            run.step(h / 4)
        want = run.output("position_x", mbd.station(other, 7, 1.0)) - 8.0
        self.assertLess(abs(1e-4 * (C @ x)[0] - want), 2e-3 * abs(want))
        # sparse: the lowest frequency of R' K R, R' M R is that of the modes
        M, K, R = full.M, full.K, full.R
        self.assertEqual(full.J.shape[0], 0)
        square = scipy.linalg.eigh((R.T @ K @ R).toarray(), (R.T @ M @ R).toarray(), eigvals_only=True)
        modes = sim.modes(count=4)
        found = [mode.frequency for mode in modes]
        self.assertLess(max(abs(numpy.sqrt(abs(square[:4])) / (2 * numpy.pi) - found)), 1e-6 * max(found))
        reduced = sim.state_space(inputs, outputs[:1], modes=modes, shift=0.5)
        self.assertEqual(reduced.info.coordinates, 5)
        self.assertEqual(reduced.shapes.shape, (5, reduced.info.rows))
        arrays = run.arrays
        self.assertEqual(arrays.velocity.shape, (reduced.info.rows,))
        self.assertAlmostEqual(arrays.position[-1, 0], run.pose(mbd.station(other, 7, 1.0)).position[0], 12)
        along = arrays.place(mbd.station(other, 7, 1.0), mbd.X)
        self.assertAlmostEqual(sum(f * arrays.velocity[row] for row, f in along.items()),
                               run.motion(mbd.station(other, 7, 1.0)).velocity[0], 12)
        self.assertEqual(arrays.row(0).part.index, other.index)
        self.assertEqual(arrays.residual.shape, arrays.velocity.shape)
        with self.assertRaises(mbd.Error):
            sim.state_space(inputs, outputs, modes=modes, mode_list=[99])

    def test_fatigue(self):
        counted = self.sim.fatigue([self.places[4]], curve_stress=1e8, slope=4.0, classes=64)
        counted.take()
        self.assertEqual(counted.result().samples, 1)
        self.assertEqual(counted.result().damage, 0.0)
        self.assertEqual(len(counted.histogram()[0]), 64)
        with self.assertRaises(mbd.Error) as raised:
            self.sim.fatigue([self.places[4]])
        self.assertIn("curve_stress", str(raised.exception))

    def test_torque_drag(self):
        found = self.sim.torque_drag([mbd.OPERATION_PICK_UP,
                                      mbd.usual_operation(mbd.OPERATION_DRILL, weight_on_bit=1e3)],
                                     [5.0, 10.0], friction=0.25)
        self.assertEqual([len(row) for row in found.rows], [2, 2])
        self.assertEqual([mbd.operation_name(kind) for kind in range(6)],
                         ["pick-up", "slack-off", "rotate", "drill", "slide", "back-ream"])
        self.assertAlmostEqual(found.column("hook_load")[1], 2.0 * found.column("hook_load")[0])
        self.assertAlmostEqual(self.sim.friction_factor(mbd.OPERATION_PICK_UP, hook_load=found.column("hook_load")[1]),
                               0.25)
        along = self.sim.torque_drag_profile(mbd.OPERATION_PICK_UP, 11, friction=0.25)
        self.assertAlmostEqual(along["axial_force"][0], found.column("hook_load")[1])
        self.assertAlmostEqual(along["depth"][5], 5.0)
        with self.assertRaises(mbd.Error) as raised:
            self.sim.torque_drag(depths=[11.0])
        self.assertIn("depth", str(raised.exception))
        with self.assertRaises(ValueError):
            self.sim.friction_factor(mbd.OPERATION_PICK_UP)

    @there("numpy")
    def test_shapes(self):
        modes = self.sim.modes(count=6, contact=mbd.CONTACT_OPEN)
        shapes = modes.shapes(0, self.places)
        self.assertEqual(shapes.shape, (10, 6))
        self.assertEqual(shapes[4, 1], complex(modes.shape(0, self.places[4]).re[1],
                                               modes.shape(0, self.places[4]).im[1]))
        self.assertEqual(list(modes.frequencies), sorted(mode.frequency for mode in modes))

    @there("numpy", "matplotlib.pyplot")
    def test_names_with_brackets_in_legends(self):
        """A legend is the head of the column without its unit, also if the part has brackets in its name."""
        from drillmbd import plots
        import numpy
        heads = ["time [s]", "drive_force of drive table [left] [N m]", "drive_force of drive table [right] [N m]"]
        figure = plots.history(numpy.zeros((2, 3)), heads)
        self.assertEqual([one.get_text() for one in figure.axes[0].get_legend().get_texts()],
                         ["drive_force of drive table [left]", "drive_force of drive table [right]"])
        mbd.plots.need("matplotlib.pyplot").close("all")

    @there("numpy", "matplotlib.pyplot")
    def test_torsion_is_drawn(self):
        """A mode that only twists shows its twist, and no rounding of displacements drawn large."""
        from drillmbd import plots
        model = mbd.Model()
        model.set_environment(gravity=(0, 0, 0))
        string = model.add_string(start_free=mbd.FREE_NONE)
        model.add_pipes(10, string=string, kind=mbd.PIPE_AXIAL_TORSIONAL)
        model.compile()
        with model.sim() as sim:
            modes = sim.modes(count=1)
            self.assertAlmostEqual(modes[0].share[1], 1.0)
            figure = plots.shapes(modes, [mbd.station(string, i, 1.0) for i in range(10)], range(1, 11))
        lines = {line.get_label(): abs(line.get_ydata()) for line in figure.axes[0].get_lines()}
        self.assertAlmostEqual(lines["twist"].max(), 1.0)
        for name in "xyz":
            self.assertLess(lines[name].max(), 1e-6)
        mbd.plots.need("matplotlib.pyplot").close("all")

    @there("numpy", "pandas")
    def test_frames_of_analyses(self):
        rows = self.sim.profile_recorder([mbd.PROFILE_DISTANCE, mbd.PROFILE_TORQUE], 5, 3)
        rows.take()
        frame = rows.frame()
        self.assertEqual(list(frame.columns), ["time [s]", "along the string [m]", "distance [m]", "torque [N m]"])
        self.assertEqual(frame["along the string [m]"].tolist(), frame["distance [m]"].tolist())
        self.assertEqual(rows.along.shape, (5,))
        counted = self.sim.string_fatigue(self.string, 10, curve_stress=1e8, slope=4.0)
        counted.take()
        frame = counted.frame()
        self.assertEqual(frame["pipe"].tolist(), list(range(10)))
        self.assertEqual(frame["damage [-]"].tolist(), [one.damage for one in counted.results])
        self.assertEqual(len(counted.counter.frame()), 21)  # beginnings and middles, and the end of the last pipe
        along = self.sim.torque_drag_profile(mbd.OPERATION_PICK_UP, 4)
        self.assertEqual(list(along.frame().columns), ["depth [m]", "axial force [N]", "torque [N m]",
                                                       "wall force [N/m]"])
        self.assertEqual(along.frame()["depth [m]"].tolist(), along["depth"])
        bands, severity = self.sim.speeds([mbd.Order()], [(self.places[4], "vibration_z")], [1e-9], points=20,
                                          speed_low=2.0, speed_high=40.0, contact=mbd.CONTACT_OPEN)
        self.assertEqual((bands.speeds[0], bands.speeds[-1], len(bands.speeds)), (2.0, 40.0, 20))
        self.assertEqual(bands.severity_frame()["severity [-]"].tolist(), severity)
        self.assertEqual(len(bands.frame()), len(bands))

    @there("numpy", "pandas")
    def test_frames(self):
        frame = self.sim.profile(self.string, 10).frame()
        self.assertEqual(frame.shape[0], 21)
        self.assertIn("axial force [N]", frame.columns)
        recorder = self.model.sim().recorder([(self.places[9], mbd.OUTPUT_POSITION_Z)], capacity=4)
        recorder.take()
        self.assertTrue(recorder.frame().columns[1].endswith("[m]"))
        self.assertIn("frequency [Hz]", self.sim.modes(count=3, contact=mbd.CONTACT_OPEN).frame().columns)

    @there("numpy", "matplotlib.pyplot")
    def test_pictures(self):
        import matplotlib
        matplotlib.use("Agg")
        from drillmbd import plots
        profile = self.sim.profile(self.string, 10)
        modes = self.sim.modes(count=4, contact=mbd.CONTACT_OPEN)
        response = self.sim.response([mbd.Excitation(place=self.places[9], component=mbd.Z)],
                                     [(self.places[9], "vibration_z")], points=20,
                                     contact=mbd.CONTACT_OPEN)
        band = mbd.SpeedBand(low=2.0, high=3.0)
        rows = self.sim.profile_recorder([mbd.PROFILE_DISTANCE, mbd.PROFILE_BENDING_MOMENT], 5, 3)
        rows.take()
        table = mbd.numpy.array([[0.01 * i, math.sin(0.2 * math.pi * i), 3.0] for i in range(200)])
        figures = [plots.causes(response, ["a force"], label="tip [m]"), plots.frequencies(modes),
                   plots.study([1.0, 2.0], {"a [Hz]": [1.0, 2.0], "b [m]": [3.0, 4.0]}, "length [m]", log=True),
                   plots.orbit(table[:, 1], table[:, 2], 0.01), plots.over_time(rows, 1),
                   plots.spectrum(table, ["time [s]", "a [m]", "b [m]"]), plots.profile(profile, "statics"),
                   plots.string(profile, 0.094),
                   plots.shapes(modes, self.places, [i + 1.0 for i in range(10)]),
                   plots.response(response, ["tip [m/N]"]),
                   plots.severity([1.0, 2.0, 3.0], [0.1, 2.0, 0.3], [band]),
                   plots.history(mbd.numpy.zeros((3, 3)), ["time [s]", "a [m]", "b [N]"]),
                   plots.buckling(modes.shapes(0, self.places).real, range(10), 2.5)]
        line = figures[5].axes[0].get_lines()[0]  # a sine of 10 Hz and amplitude 1
        at = line.get_ydata().argmax()
        self.assertAlmostEqual(line.get_xdata()[at], 10.0, delta=0.5)
        self.assertAlmostEqual(line.get_ydata()[at], 1.0, delta=0.03)
        with self.assertRaisesRegex(ValueError, "equal times"):
            plots.spectrum([[0.0, 1.0], [0.1, 1.0], [0.5, 1.0]], ["time [s]", "a [m]"])
        self.assertEqual(figures[6].axes[2].get_xlabel(), "bending moment [N m]")  # 46 N m at most: no kN m
        with tempfile.TemporaryDirectory() as folder:
            for number, figure in enumerate(figures):
                for axes in figure.axes:
                    self.assertTrue(axes.get_xlabel() or axes.get_ylabel() or axes.get_shared_x_axes())
                path = pathlib.Path(folder, f"{number}.png")
                figure.savefig(path)
                self.assertGreater(path.stat().st_size, 5000)
        matplotlib.pyplot.close("all")


class GrowthTest(unittest.TestCase):
    """10000 cycles by measure.py; here a part of them."""

    def test_cycles_do_not_grow(self):
        def cycle():
            model = mbd.Model()
            string = model.add_string(start_free=mbd.FREE_X)
            model.add_drive(part=model.add_pipes(2, string=string), time_function=model.add_time_function(ramp))
            model.compile()
            with model.sim() as sim:
                sim.step(1e-3)
                sim.static()
                copy.copy(model).close()

        for _ in range(100):
            cycle()
        gc.collect()
        before = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
        for _ in range(400):
            cycle()
        gc.collect()
        self.assertLess(resource.getrusage(resource.RUSAGE_SELF).ru_maxrss - before, 1024)  # [KiB]


if __name__ == "__main__":
    unittest.main()
