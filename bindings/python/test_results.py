"""Tests of how results read in Python: arrays of numpy, mappings, parts by their names, lists where C has pointers."""
import copy
import inspect
import pickle
import types
import unittest
from importlib import import_module

from shared_tests import needs

needs("numpy")

import numpy as np  # noqa: E402

import drillmbd as mbd  # noqa: E402
from drillmbd import _structs, errors  # noqa: E402
from drillmbd._handle import Handle  # noqa: E402
from drillmbd.analysis import Shaped  # noqa: E402
from drillmbd.sim import SimAt  # noqa: E402


class ResultsTest(unittest.TestCase):
    def setUp(self):
        self.model = mbd.Model()
        self.model.add_wall(survey=[(0.0, 1.5, 0.0), (50.0, 1.55, 0.1), (100.0, 1.6, 0.1)])
        self.string = self.model.add_pipes(10, length=3.0, damping_time=1e-3)
        self.model.set_name(self.string, "rods")
        self.bit = self.model.add_bit(name="bit")
        turning = self.model.add_time_function(mbd.Segment(kind=mbd.SEGMENT_STEP5, x1=0.1, h1=10.0))
        self.table = self.model.add_drive(part=self.string, component=mbd.RX, time_function=turning, name="table")
        self.feed = self.model.add_drive(part=self.string, time_function=self.model.add_time_function(0.0), name="feed")
        self.load = self.model.add_load(place=self.bit, force=(1.0, 0.0, 0.0), name="feed",
                                        time_function=self.model.add_time_function(1.0))
        self.model.compile()
        self.sim = self.model.sim()
        self.addCleanup(self.sim.close)
        self.sim.run(0.05, step=1e-3)

    def test_arrays(self):
        pose = self.sim.pose(mbd.station(self.string, 9, 1.0))
        self.assertIsInstance(pose.position, np.ndarray)
        self.assertEqual((pose.position.shape, pose.rotation.shape, pose.position.dtype),
                         ((3,), (3, 3), np.dtype("float64")))
        np.testing.assert_allclose(pose.rotation @ pose.rotation.T, np.eye(3), atol=1e-14)
        self.assertAlmostEqual(np.linalg.det(pose.rotation), 1.0)
        start = self.model.hole(0.0)
        self.assertLess(np.linalg.norm(self.sim.pose("rods").position - start.position), 0.1)
        motion = self.sim.motion("bit", mbd.FRAME_BODY)
        self.assertAlmostEqual(motion.velocity[3], self.sim.output("spin", mbd.station(self.string, 9, 1.0)), 6)

    def test_arrays_share_memory(self):
        """A slice that is written to changes the struct; a struct that is copied does not share."""
        joint = mbd.JointDef(origin_a=(1.0, 2.0, 3.0))
        joint.origin_a[0] += 5.0
        other = copy.copy(joint)
        joint.origin_a[:] = 0.0
        self.assertEqual((list(joint.origin_a), list(other.origin_a)), ([0.0, 0.0, 0.0], [6.0, 2.0, 3.0]))
        other.origin_a = np.array([1.0, 1.0, 1.0])
        self.assertEqual(pickle.loads(pickle.dumps(other)), other)
        with self.assertRaises(mbd.Error):
            other.origin_a = np.eye(2)
        pose = self.sim.pose("bit")
        again = mbd.Pose(**pose.describe())
        np.testing.assert_array_equal(again.rotation, pose.rotation)
        again.rotation = np.eye(3)
        np.testing.assert_array_equal(again.rotation, np.eye(3))

    def test_mappings(self):
        energy = self.sim.energy()
        self.assertEqual(dict(energy), energy._asdict())
        self.assertEqual({**energy}["kinetic"], energy.kinetic)
        self.assertEqual(energy["kinetic"], energy.kinetic)
        self.assertNotIn("struct_size", energy.keys())
        with self.assertRaises(KeyError):
            energy["cinetic"]
        with self.assertRaises(TypeError):
            list(energy)
        self.assertEqual(sorted(self.sim.pose("bit").keys()), ["depth", "displacement", "position", "rotation"])

    def test_parts_by_name(self):
        self.assertEqual(self.sim.drive("table"), self.sim.drive(self.table))
        self.assertEqual(self.sim.drive("feed"), self.sim.drive(self.feed))  # a load has the name, too
        self.assertEqual(self.sim.bit("bit"), self.sim.bit(self.bit))
        self.assertEqual(self.sim.output("drive_force", "table"), self.sim.drive(self.table).force)
        self.assertEqual(self.sim.output(self.table, "drive_force"), self.sim.drive(self.table).force)
        self.assertEqual(self.sim.rotation("rods"), self.sim.rotation(self.string))
        with self.assertRaisesRegex(mbd.Error, "table.* may not jump"):
            self.sim.set_drive("table", 3.0)

    def test_names_that_are_wrong(self):
        for name, text in (("tabel", "'rods', 'bit', 'table', 'feed'.*; 'table'"), ("", "name of a part")):
            with self.assertRaisesRegex(mbd.Error, text) as caught:
                self.sim.drive(name)
            self.assertEqual((caught.exception.part, caught.exception.field), ("drive", "part"))
        with self.assertRaisesRegex(mbd.Error, "drive 1 and load 0 have this name"):
            self.sim.pose("feed")
        with self.assertRaisesRegex(mbd.Error, "must be a drive"):
            self.sim.drive("bit")

    def test_recorder(self):
        recorder = self.sim.recorder([("table", "drive_force"), ("bit", "position_x"), "bit_speed",
                                      (self.string, "rotation")], 10)
        self.assertEqual(recorder.columns, ["time [s]", "drive_force of drive table [N m]", "position_x of bit bit [m]",
                                            "bit_speed [rad/s]",
                                            "rotation of string rods pipe 0 at 0 [rad]"])
        recorder.take()
        self.assertEqual(recorder.table[0, 1], self.sim.drive("table").force)

    def test_profile_of_the_string(self):
        whole = self.sim.profile()
        self.assertEqual(len(whole.axial_force), 21)
        np.testing.assert_array_equal(whole.axial_force, self.sim.profile("rods", 10).axial_force)

    def test_extremes_of_the_profile(self):
        whole = self.sim.profile()
        found = self.sim.profile_extremes([mbd.PROFILE_VON_MISES, mbd.PROFILE_EFFECTIVE_FORCE])
        for quantity, one in found.items():
            values = whole[quantity]
            self.assertEqual((one.minimum, one.maximum), (np.nanmin(values), np.nanmax(values)))
            self.assertEqual((one.minimum_at, one.maximum_at),
                             (whole.along[np.nanargmin(values)], whole.along[np.nanargmax(values)]))

    def test_survey_as_a_list(self):
        """survey is the name that C has; it is described, copied and pickled as stations are."""
        rows = [(0.0, 1.5, 0.0), (50.0, 1.55, 0.1), (100.0, 1.6, 0.1)]
        wall = mbd.WallDef(survey=np.array(rows))
        self.assertEqual(wall, mbd.WallDef(stations=rows))
        again = pickle.loads(pickle.dumps(self.model))
        np.testing.assert_array_equal(again.hole(70.0).position, self.model.hole(70.0).position)
        self.assertGreater(abs(self.model.hole(70.0).position[1]), 1.0)
        with self.assertRaises(TypeError):
            mbd.WallDef(survey=rows, stations=rows)
        with self.assertRaises(mbd.Error):
            mbd.WallDef(survey=[(1.0, 2.0)])

    def test_depths_as_a_list(self):
        options = mbd.TorqueDragOptions(depths=[10.0, 20.0])
        self.assertEqual(options.depth_count, 2)
        by_options = self.sim.torque_drag(["pick-up"], options=options).column("hook_load")
        self.assertEqual(by_options, self.sim.torque_drag(["pick-up"], [10.0, 20.0]).column("hook_load"))

    def test_results_as_mappings(self):
        profile = self.sim.profile(self.string, 5)
        self.assertEqual(set(dict(profile)), set(profile._asdict()))
        rows = self.sim.torque_drag(depths=[5.0, 10.0])
        self.assertEqual(rows._asdict()["torque"],
                         [row[k].torque for row in rows.rows for k in range(len(rows.operations))])
        recorder = self.sim.recorder([("table", "drive_force"), "bit_speed"], capacity=2)
        recorder.take()
        self.assertEqual(list(recorder._asdict()), ["time [s]", "drive_force of drive table [N m]",
                                                    "bit_speed [rad/s]"])

    def test_every_result_is_a_mapping(self):
        """_asdict of every class of the package that is a result: those with a frame and those that hold one of C, but
        for scenes, runs and functions of the state."""
        modules = ("analysis", "state_space", "sensitivity", "state_equation", "frames", "fatigue", "window",
                   "recorder", "profile", "inputs", "sim", "model")
        members = [one for name in modules for one in vars(import_module("drillmbd." + name)).values()]
        classes = {one for one in members if inspect.isclass(one) and one.__module__.startswith("drillmbd") and
                   not issubclass(one, mbd.Record)}
        results = {one for one in classes if hasattr(one, "frame") or issubclass(one, Handle) or
                   one.__name__ == "InputLog"}
        results -= {Handle, mbd.Model, mbd.Sim, SimAt, Shaped, mbd.StateEquation}
        found = self.results()
        self.assertEqual({type(one) for one in found} - results, set())
        self.assertEqual(results - {type(one) for one in found}, set(), "a result without an example here")
        for one in found:
            fields = one._asdict()
            self.assertIs(type(fields), dict, type(one))
            self.assertTrue(fields and all(isinstance(name, str) for name in fields), type(one))
        for one in vars(_structs).values():
            if inspect.isclass(one) and issubclass(one, mbd.Record) and one.c_name and "Segment" not in one.__name__:
                self.assertEqual(list(one()._asdict()), one().keys(), one)

    def results(self):
        """A result of each class, with something in it."""
        sim, middle = self.sim, mbd.station(self.string, 5, 0.5)
        takers = [sim.recorder(["bit_speed"], 4), sim.profile_recorder([mbd.PROFILE_TORQUE], 3, 4),
                  sim.window(["bit_speed"]), sim.fatigue([middle], curve_stress=1e8, slope=3.0),
                  sim.string_fatigue(self.string, 10, curve_stress=1e8, slope=3.0)]
        for one in takers:
            one.take()
        rest = self.at_rest()
        excitation = mbd.Excitation(place=mbd.station(rest.string, 5, 0.5), component=mbd.Z)
        outputs = [(mbd.station(rest.string, 5, 0.5), "vibration_z")]
        bands, _ = rest.sim.speeds([mbd.Order(excitation=excitation)], outputs, [1e-3], speed_low=1.0, speed_high=30.0)
        return takers + [sim.profile(self.string, 5), sim.torque_drag(depths=[5.0]),
                         sim.torque_drag_profile("pick-up", 5), rest.sim.modes(count=3), rest.sim.buckling(follow=0),
                         bands, rest.sim.response([excitation], outputs, points=4),
                         rest.sim.state_space([excitation], outputs),
                         rest.sim.state_space([], [], form=mbd.STATE_MATRICES), rest.sensitivity(), rest.log()]

    def test_mappings_hold_their_results(self):
        rest = self.at_rest()
        modes, buckling = rest.sim.modes(count=3), rest.sim.buckling(follow=0)
        self.assertEqual(modes._asdict()["frequency"], [one.frequency for one in modes])
        self.assertEqual(buckling._asdict(),
                         {"factor": buckling.factors, "confirmed": [False] * len(buckling.factors)})
        self.assertTrue(buckling.factors)
        space = rest.sim.state_space([mbd.Excitation(place=rest.station, component=mbd.Z)],
                                     [(rest.station, "vibration_z")])
        for name, matrix in space._asdict().items():
            np.testing.assert_array_equal(matrix, getattr(space, name))
        matrices = rest.sim.state_space([], [], form=mbd.STATE_MATRICES)
        self.assertEqual(list(matrices._asdict()), ["M", "damping", "K", "J", "R"])

    def at_rest(self):
        """A clamped pipe under a push, at rest."""
        rest = types.SimpleNamespace()

        def describe(push=-1e3):
            model = mbd.Model()
            rest.string = model.add_string(follows_hole=0, start_free=mbd.FREE_NONE, name="rods")
            model.add_pipes(6, string=rest.string, length=1.0)
            model.add_load(place=mbd.station(rest.string, 5, 1.0), force=(push, 0.0, 0.0), frame=mbd.FRAME_BODY)
            model.compile()
            return model

        rest.sim = describe().sim()
        rest.sim.static(lay_on_wall=0)
        rest.station = mbd.station(rest.string, 5, 0.5)
        self.addCleanup(rest.sim.close)

        def sensitivity():
            found = mbd.sensitivity_of(describe, {"push": -1e3})
            found.step(1e-3)
            return found

        def log():
            self.model_with_input = mbd.Model()
            load = self.model_with_input.add_load(place=self.model_with_input.add_body(), force=(1.0, 0.0, 0.0))
            self.model_with_input.add_input(name="push", part=load, target=mbd.TARGET_LOAD_FACTOR)
            self.model_with_input.compile()
            run = self.model_with_input.sim()
            self.addCleanup(run.close)
            kept = run.inputs.record(3)
            run.inputs["push"] = 2.0
            return kept

        rest.sensitivity, rest.log = sensitivity, log
        return rest

    def test_outputs_alike_in_recorder_and_window(self):
        window = self.sim.window(["bit_speed", ("table", "drive_force")])
        window.take()
        self.assertEqual(window.result(1).mean, self.sim.output("drive_force", "table"))

    def test_messages_name_methods(self):
        model = mbd.Model()
        model.add_pipes(2)
        with self.assertRaisesRegex(mbd.Error, r"not compiled, call compile\(\) first"):
            model.sim()
        self.assertNotIn("dmb_", model.message)
        self.assertEqual(errors.in_python("ask for DMB_FREE_..., or dmb_sim_advance"), "ask for FREE_..., or advance()")

    def test_wrong_names(self):
        with self.assertRaises(AttributeError) as caught:
            mbd.PipeDef(outer_diamter=0.07)
        self.assertEqual((caught.exception.name, caught.exception.status), ("DMB_ERR_VALUE", mbd.ERR_VALUE))

    def test_shown(self):
        model = mbd.Model()
        model.add_pipes(7)
        model.add_pipes(3)
        self.assertEqual(repr(model), "<Model of 10 pipes, described>")
        model.compile()
        self.assertEqual(repr(model), "<Model of 10 pipes, compiled>")
        model.close()
        self.assertEqual(repr(model), "<Model, closed>")
        self.assertRegex(repr(self.sim), r"^<Sim of 10 pipes at 0\.05 s, \d+ steps>$")


if __name__ == "__main__":
    unittest.main()
