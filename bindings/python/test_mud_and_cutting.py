"""Fields by which mud goes along with bodies, bits and rings, motors take pressure, and cutters widen the hole: from
Python and from scene files, there and back, against closed forms."""
import math
import unittest

import drillmbd as mbd

try:
    from drillmbd import scene
except ImportError as missing:
    raise unittest.SkipTest(f"not there: {missing.name}") from missing

MOVED = """
[environment]
gravity = [0, 0, 0]
fluid_density = "1200 kg/m^3"
[[body]]
name = "sphere"
mass = "10 kg"
added_mass = ["2 kg", "7000 g"]
[[load]]
place = "sphere"
force = FORCE
[[string]]
name = "main"
position = [0, "3 m", 0]
follows_hole = false
start_free = ["x", "y", "z", "rx", "ry", "rz"]
velocity = VELOCITY
[[string.pipes]]
kind = "rigid"
[[stabiliser]]
name = "collar"
mass = "6 kg"
outer_diameter = "100 mm"
added_mass = ["1 kg", "4 kg"]
[[bit]]
name = "bit"
mass = "20 kg"
added_mass = ["0.5 kg", "8 kg"]
"""

MOTOR = """
[environment]
gravity = [0, 0, 0]
fluid_density = "1100 kg/m^3"
consistency = "0.05 Pa s"
flow_rate = "720 l/min"
[hole]
direction = [0, 0, -1]
diameter = "96 mm"
[[string]]
name = "main"
[[string.pipes]]
count = 2
kind = "rigid"
[[body]]
name = "shaft"
mass = "50 kg"
position = [0, 0, "-2 m"]
rotation = [0, "90 deg", 0]
[[joint]]
name = "bearing"
kind = "revolute"
place_a = {part = "main", pipe = 1, fraction = 1.0}
place_b = "shaft"
[[drive]]
name = "motor"
part = "bearing"
motor = {flow = "720 l/min", displacement = "20 l", pressure = "40 bar", efficiency = 0.8}
"""

CUT = """
[environment]
gravity = [0, 0, 0]
[hole]
diameter = "100 mm"
friction_law = "none"
cut_spacing = "10 cm"
cut_start = "1 m"
cut_end = "8 m"
[[string]]
name = "main"
[[string.pipes]]
count = 2
kind = "rigid"
[[bit]]
name = "bit"
diameter = 0
radius = "60 mm"
rock_law = "rate"
intrinsic_energy = "10 kPa"
contact_strength = 0
[[drive]]
name = "feed"
component = "x"
time_function = "1 m/s"
[[drive]]
name = "head"
component = "rx"
time_function = "10 rad/s"
"""


class TwoWays(unittest.TestCase):
    """A scene as it is written, and as it comes back from what is saved of it."""

    def both(self, text):
        first = scene.loads(text)
        saved = scene.saves(first)
        second = scene.loads(saved)
        self.assertTrue(second.same_as(first))
        self.assertEqual(scene.saves(second), saved)
        return first, second

    def near(self, found, wanted, part=1e-9):
        self.assertLessEqual(abs(found - wanted), part * abs(wanted), f"{found}, not {wanted}")


class AddedMassTest(TwoWays):
    def test_body_that_is_pushed(self):
        for axis, added in ((0, 2.0), (1, 7.0), (2, 7.0)):
            force = [0, 0, 0]
            force[axis] = "60 N"
            for loaded in self.both(MOVED.replace("FORCE", str(force)).replace("VELOCITY", "[0, 0, 0, 0, 0, 0]")):
                with loaded.new_sim() as sim:
                    for _ in range(50):
                        sim.step(0.01)
                    moved = sim.pose(mbd.station(loaded.names["sphere"])).displacement
                    self.near(moved[axis], 0.5 * 60.0 / (10.0 + added) * 0.25)

    def test_bit_and_ring_that_move(self):
        for axis, added in ((0, 1.5), (1, 12.0), (2, 12.0)):
            velocity = [0] * 6
            velocity[axis] = "2 m/s"
            for loaded in self.both(MOVED.replace("FORCE", "[0, 0, 0]").replace("VELOCITY", str(velocity))):
                with loaded.new_sim() as sim:
                    string = sim.momentum().mass - 10.0
                    self.assertGreater(string, 26.0)
                    self.near(sim.energy().kinetic, 0.5 * (string + added) * 4.0)

    def test_no_mass_below_nothing(self):
        for part in ('added_mass = ["2 kg", "7000 g"]', 'added_mass = ["0.5 kg", "8 kg"]'):
            text = MOVED.replace("FORCE", "[0, 0, 0]").replace("VELOCITY", "[0, 0, 0, 0, 0, 0]")
            self.assertIn(part, text)
            with self.assertRaisesRegex(scene.SceneError, "added_mass"):
                scene.loads(text.replace(part, 'added_mass = ["-1 kg", 0]'))


class MotorPressureTest(TwoWays):
    """At stall, at time 0: torque and loss by the line of the motor."""
    DISPLACEMENT, PRESSURE, EFFICIENCY, FLOW = 0.02, 4e6, 0.8, 0.012

    def test_loss_of_a_motor(self):
        stall = self.EFFICIENCY * self.DISPLACEMENT * self.PRESSURE / (2.0 * math.pi)
        for loaded in self.both(MOTOR):
            drive = dict(loaded.model.calls)["add_drive"][0]
            self.near(drive["mud_pressure"], 2.0 * math.pi / (self.EFFICIENCY * self.DISPLACEMENT))
            self.near(drive["limit_high"], stall)
            with loaded.new_sim() as sim:
                flow = sim.flow()
                self.near(flow.motor_loss, self.PRESSURE)
                self.near(flow.pump_pressure, flow.bore_loss + flow.bit_loss + flow.annulus_loss + flow.column
                          + flow.motor_loss)
                sim.step(0.01)
                self.near(sim.flow().motor_loss, drive["mud_pressure"] * sim.drive(loaded.names["motor"]).force)

    def test_the_same_by_the_drive(self):
        """mud_pressure as a key and a field of the drive, in the place of a motor."""
        line, speed = mbd.motor_drive(displacement=self.DISPLACEMENT, flow=self.FLOW, pressure=self.PRESSURE,
                                      efficiency=self.EFFICIENCY)
        self.near(line.mud_pressure, 2.0 * math.pi / (self.EFFICIENCY * self.DISPLACEMENT))
        self.near(speed, 2.0 * math.pi * self.FLOW / self.DISPLACEMENT)
        keys = (f'kind = "control"\ncomponent = "rx"\ngain = "{line.gain!r} N m s"\nlimit_low = 0\n'
                f'limit_high = "{line.limit_high!r} N m"\ntime_function = "{speed!r} rad/s"\nmud_pressure = '
                f'"{line.mud_pressure!r} Pa/(N m)"\n')
        motor = next(one for one in MOTOR.splitlines() if one.startswith("motor"))
        ends = []
        for text in (MOTOR, MOTOR.replace(motor, keys)):
            for loaded in self.both(text):
                with loaded.new_sim() as sim:
                    for _ in range(10):
                        sim.step(1e-3)
                    ends.append((sim.flow().motor_loss, sim.flow().pump_pressure,
                                 sim.drive(loaded.names["motor"]).speed))
        self.assertEqual(len(set(ends)), 1)
        self.assertGreater(ends[0][2], 0.0)
        with self.assertRaisesRegex(scene.SceneError, "mud_pressure"):
            scene.loads(MOTOR.replace(motor, keys.replace("mud_pressure = \"", "mud_pressure = \"-")))


class CutHoleTest(TwoWays):
    def test_hole_as_it_is_now(self):
        for loaded in self.both(CUT):
            with loaded.new_sim() as sim:
                before = [sim.hole(depth).diameter for depth in (0.5, 1.5, 2.5, 7.0)]
                self.assertEqual(before, [loaded.model.hole(depth).diameter for depth in (0.5, 1.5, 2.5, 7.0)])
                for _ in range(200):
                    sim.step(0.01)
                face = 4.0  # [m] two pipes of 1 m, and 2 m of feed
                described, cut = 0.1, 0.12
                self.near(sim.hole(2.5).diameter, cut)
                self.near(sim.hole(face - 0.25).diameter, cut)
                for depth in (0.5, face + 0.2, 7.9, 9.0):
                    self.near(sim.hole(depth).diameter, described)
                for depth in (0.5, 2.5, 7.0):
                    self.near(loaded.model.hole(depth).diameter, described)
                saved = sim.snapshot()
                with loaded.new_sim() as other:
                    self.near(other.hole(2.5).diameter, described)
                    other.restore(saved)
                    self.near(other.hole(2.5).diameter, cut)

    def test_stations_that_are_too_few(self):
        with self.assertRaisesRegex(scene.SceneError, "cut_"):
            scene.loads(CUT.replace('cut_end = "8 m"', 'cut_end = "1.2 m"'))
        model = mbd.Model()
        with self.assertRaisesRegex(mbd.Error, "cut_spacing"):
            model.add_wall(cut_spacing=-0.1, cut_end=8.0)


if __name__ == "__main__":
    unittest.main()
