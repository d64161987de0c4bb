"""Control design from the state space of a scene: a speed controller for the rotation of 300 m of rods that takes
torsional waves out of the string, as against stick-slip. The gain is chosen on a reduced model and tried in a run of
the scene itself. Needs numpy and scipy."""
import math

import numpy as np
from scipy.linalg import eigvals, expm
import drillmbd as mbd

PIPES, LENGTH, END, INTEGRAL = 100, 3.0, 3.0, 40.0  # [-, m, s, N m]


def scene(gain, kick=0.0):
    """Axial-torsional rods on a controlled rotary drive without wall; a hump of 200 N m over 2 `kick` [s] hits the
    bit."""
    model = mbd.Model()
    model.set_environment(gravity=(0.0, 0.0, 0.0))
    string = model.add_string(start_free=mbd.FREE_CYLINDRICAL)
    model.add_wall(friction_law=mbd.FRICTION_NONE)
    model.add_pipes(PIPES, string=string, kind=mbd.PIPE_AXIAL_TORSIONAL, outer_diameter=0.0635, inner_diameter=0.0515,
                    length=LENGTH, damping_time=1e-4)
    model.add_drive(part=string, time_function=model.add_time_function(mbd.Segment()))  # the feed stands still
    still = model.add_time_function(mbd.Segment())
    drive = model.add_drive(part=string, component=mbd.RX, kind=mbd.DRIVE_LOAD if gain is None else mbd.DRIVE_CONTROL,
                            gain=gain or 0.0, integral_gain=0.0 if gain is None else INTEGRAL, time_function=still)
    hump = [mbd.Segment(kind=mbd.SEGMENT_STEP, h1=sign, x0=at, x1=at + kick) for sign, at in ((1.0, 0.0), (-1.0, kick))
            if kick]
    load = model.add_load(place=mbd.station(string, PIPES - 1, 1.0), frame=mbd.FRAME_BODY, moment=(200.0, 0.0, 0.0),
                          time_function=model.add_time_function(*(hump or [mbd.Segment()])))
    torque = model.add_input(name="torque", part=drive) if gain is None else mbd.Id()  # what a controller writes
    model.compile()
    return mbd.Sim(model), string, torque, load


def plant():
    """Torque of the rig [N m] and factor of the kick to rotation and speed of the rig end and speed of the bit."""
    sim, string, torque, load = scene(None)
    modes = sim.modes(count=40)
    torsional = [i for i, mode in enumerate(modes) if mode.share[1] > 0.9]  # what feed and push shake is left out
    inputs = [mbd.Excitation(kind=kind, place=mbd.station(part))
              for kind, part in ((mbd.EXCITATION_SETTING, torque), (mbd.EXCITATION_LOAD, load))]
    outputs = [(mbd.OUTPUT_ROTATION, mbd.station(string)), (mbd.OUTPUT_ROTARY_SPEED, mbd.station(string)),
                (mbd.OUTPUT_BIT_SPEED, mbd.station(string))]
    outputs = [(place, quantity) for quantity, place in outputs]
    return sim.state_space(inputs, outputs, modes=modes, mode_list=torsional, shift=0.02)


def closed(space, gain):
    """A of the plant with torque = -gain speed - INTEGRAL rotation."""
    return space.A - space.B[:, :1] @ (gain * space.C[1:2] + INTEGRAL * space.C[0:1])


def damping(A):
    """Least damping ratio of what swings below 10 Hz."""
    roots = [s for s in eigvals(A) if s.imag > 0.1 and abs(s) < 20.0 * math.pi]
    return min(-s.real / abs(s) for s in roots)


def main():
    space = plant()
    section = math.pi / 32.0 * (0.0635 ** 4 - 0.0515 ** 4)  # [m4]
    impedance = section * math.sqrt(206e9 / 2.6 * 7850.0)  # [N m s] of torsional waves: reflects nothing
    gains = impedance * np.geomspace(0.1, 30.0, 60)
    best = max(gains, key=lambda gain: damping(closed(space, gain)))
    print(f"{space.info.states} states for {PIPES} rods; impedance of the string {impedance:.1f} N m s, best gain "
          f"{best:.1f}")
    for name, gain in (("stiff", 20.0 * impedance), ("tuned", best)):
        A, ramp, h = closed(space, gain), 0.1, 0.0005
        sim, _, _, _ = scene(gain, ramp)
        x, step = np.zeros(len(A)), expm(h * np.block([[A, space.B[:, 1:]], [np.zeros((1, len(A) + 1))]]))
        linear, run = [], []
        for i in range(int(END / h)):
            D = max(0.0, 1.0 - abs((i + 0.5) * h / ramp - 1.0))  # STEP up and down again
            x = (step @ np.append(x, D * D * (3.0 - 2.0 * D)))[:-1]
            sim.step(h)
            linear.append(space.C[2] @ x)
            run.append(sim.output("bit_speed"))
        off = max(abs(np.subtract(linear, run))) / max(np.abs(run))
        print(f"{name}: gain {gain:6.1f}, least damping {damping(A):.3f}, bit still swings by "
              f"{100 * max(np.abs(run[-1000:])) / max(np.abs(run)):4.1f} % in the end; model off the run by "
              f"{100 * off:.1f} %")


if __name__ == "__main__":
    main()
