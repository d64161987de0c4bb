"""From a scene to numbers and pictures in Python: a string of 30 pipes in a hole that bends upward.

usage: tutorial.py [FOLDER for pictures and tables, default drillmbd-tutorial]
"""
import copy
import math
import pathlib
import sys

import drillmbd as mbd

folder = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else "drillmbd-tutorial")
folder.mkdir(parents=True, exist_ok=True)
PIPES = 30
RPM = 2.0 * math.pi / 60.0

# 1. Describe. Every number is in SI units; help(mbd.PipeDef) shows the fields, their units and defaults.
model = mbd.Model()
model.add_wall(diameter=0.094, stations=[(0, math.radians(90), 0), (10, math.radians(90), 0),
                                         (30, math.radians(96), 0), (60, math.radians(96), 0)])
string = model.add_pipes(PIPES, outer_diameter=0.073, inner_diameter=0.061, eccentricity=1e-3, angle_spread=math.pi,
                         damping_time=1e-4)
bit = model.add_bit(mass=5.0, diameter=0.0)
# Time functions are sums of terms: a smooth start, and a table of (time, value).
turning = model.add_time_function(mbd.Segment(kind=mbd.SEGMENT_STEP, x1=0.2, h1=100.0 * RPM))
feeding = model.add_time_function(mbd.Segment(table=([0.0, 0.2, 0.5], [0.0, 0.01, 0.01])))
feed = model.add_drive(time_function=feeding)
rotation = model.add_drive(component=mbd.RX, time_function=turning)
model.compile()
info = model.info()
print(f"{info.pipes} pipes, {info.mass:.1f} kg, {info.degrees_of_freedom} degrees of freedom")

# A value that does not fit is refused; the error tells part, field, value and bound, of a wrong type too.
for wrong in (-0.1, "94 mm"):
    try:
        mbd.Model().add_wall(diameter=wrong)
    except mbd.Error as error:
        print(f"refused: {error.part}, {error.field} = {error.value}, must {error.bound}")

# 2. Where does it lie? Friction as if it were pushed in.
sim = model.sim()
print(sim.check_text().splitlines()[0])
report = sim.static(slip_axial=0.01)
lying = sim.profile(string, PIPES)
print(f"static start: {report.iterations} iterations, the wall bears {lying.contact_force.sum():.0f} N, "
      f"the rig holds {sim.reaction(string)[0]:.0f} N")

# 3. Run, record, stop by Ctrl-C if need be: the sim stays whole.
sim = model.sim()
sim.static()
tip = mbd.station(string, PIPES - 1, 1.0)
recorder = sim.recorder([(tip, mbd.OUTPUT_DISPLACEMENT_Z, "far end, up [m]"),
                         (rotation, mbd.OUTPUT_DRIVE_FORCE, "torque at the rig [N m]"),
                         (feed, mbd.OUTPUT_DRIVE_FORCE, "push at the rig [N]")], capacity=1000)
done = sim.run(0.5, step=1e-3, recorder=recorder,
               progress=lambda at: print(f"\r{100 * at.fraction:3.0f} %, {at.real_time_factor:.0f} times real time",
                                         end=""))
print(f"\n{done.steps} steps; torque at the end {recorder.table[-1][2]:.1f} N m, energy error {sim.energy().error:.1e}")

# 4. Go on twice from one state: a snapshot is bytes, a model is its description.
state = sim.snapshot()
other = copy.copy(model).sim()
other.restore(state)
other.step(1e-3)
sim.step(1e-3)
print(f"a copy goes on with the same bits: {other.hash() == sim.hash()}")

# 5. At which frequencies does it swing, and what shakes it there?
sim = model.sim()
sim.static(steady=mbd.STEADY_AT_REST)
modes = sim.modes(count=12)
places = [mbd.station(string, pipe, 1.0) for pipe in range(PIPES)]
along = [pipe + 1.0 for pipe in range(PIPES)]
print("modes [Hz]: " + ", ".join(f"{frequency:.2f}" for frequency in modes.frequencies[:8]))
middle = mbd.station(string, PIPES // 2, 0.5)
response = sim.response([mbd.Excitation(kind=mbd.EXCITATION_ECCENTRICITY)],
                        [(middle, "vibration_z"), (tip, "vibration_rx")],
                        frequency_low=0.5, frequency_high=40.0, points=200)
bands, severity = sim.speeds([mbd.Order(), mbd.Order(order=2.0)], [(middle, "vibration_z")], [1e-6],
                             speed_low=20.0 * RPM, speed_high=300.0 * RPM, points=150)
print("speeds to avoid [rpm]: " + (", ".join(f"{band.low / RPM:.0f} .. {band.high / RPM:.0f}" for band in bands)
                                   or "none"))

# 6. When does it buckle? In the hole, pushed at its rig end.
pushed = mbd.Model()
pushed.add_wall(diameter=0.094)
rods = pushed.add_pipes(12, string=pushed.add_string(end_free=mbd.FREE_CYLINDRICAL & ~mbd.FREE_X))
push = pushed.add_drive(kind=mbd.DRIVE_LOAD, part=rods, time_function=pushed.add_time_function(0.0))
still = pushed.add_drive(part=rods, component=mbd.RX, time_function=pushed.add_time_function(0.0))
pushed.compile()
with pushed.sim() as column:
    column.static()
    with column.buckling(scale=mbd.SCALE_PART, part=push, count=1) as found:
        print(f"buckles at {found.factors[0] / 1e3:.1f} kN, confirmed: {found.info.confirmed == 1}")
        shape = found.shapes(0, [mbd.station(rods, pipe, 1.0) for pipe in range(12)])
        factor = found.factors[0]

# 7. Tables and pictures.
recorder.write_csv(folder / "run.csv")
sim.write_vtk(folder / "string.vtp")
model.write_vtk_hole(folder / "hole.vtp", 0.0, 35.0)
try:
    lying.frame().to_csv(folder / "profile.csv", index=False)  # a pandas frame with units in its heads
    modes.frame().to_csv(folder / "modes.csv", index=False)
except ImportError as error:
    print(error)
try:
    from drillmbd import plots
    plots.profile(lying, "statics, pushed in").savefig(folder / "statics.png")
    plots.string(lying, 0.094, "the string in its hole").savefig(folder / "string.png")
    plots.recording(recorder, "start of drilling").savefig(folder / "run.png")
    plots.shapes(modes, places, along, 5, "modes").savefig(folder / "modes.png")
    plots.frequencies(modes, "modes").savefig(folder / "frequencies.png")
    plots.response(response, ["middle, up [m]", "far end, turn [rad]"],
                   "eccentric pipes").savefig(folder / "response.png")
    plots.severity(bands.speeds, severity, bands, title="speeds to avoid").savefig(folder / "speeds.png")
    plots.buckling(shape, range(1, 13), factor, "buckling, pushed at the rig").savefig(folder / "buckling.png")
except ImportError as error:
    print(error)
print(f"{len(list(folder.iterdir()))} files in {folder}")
