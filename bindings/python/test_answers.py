"""Tests of how answers read in Python: arrays of numpy, mappings, parts by their names, lists where C has pointers."""
import copy
import pickle
import unittest

from shared_tests import needs

needs("numpy")

import numpy as np  # noqa: E402

import drillmbd as mbd  # noqa: E402
from drillmbd import errors  # noqa: E402


class AnswersTest(unittest.TestCase):
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
        self.assertRegex(repr(self.sim), r"^<Sim of 10 pipes at 0\.05 s, \d+ steps>$")


if __name__ == "__main__":
    unittest.main()
