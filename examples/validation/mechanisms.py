"""Mechanisms of the library of multibody benchmarks (IFToMM) against closed forms, other equations or published
digits."""
import math

import numpy as np

import drillmbd as mbd
from case import Case, Row, case, picture

BENCHMARKS = "González, Dopico, Lugrís, Cuadrado 2006, Multibody Syst. Dyn. 16, 179 (library of benchmarks, problem {})"
BENCHMARKS_DOI = "10.1007/s11044-006-9020-8"
GRAVITY = 9.81
GROUND = mbd.Place()


def planar(gravity=GRAVITY):
    model = mbd.Model()
    model.set_environment(gravity=(0.0, -gravity, 0.0))
    return model


def body(model, place, turned, mass, inertia, centre=0.0, across=0.0, **more):
    """A body in the x-y plane: reference point, rotation about z, centre of mass along and across its axis."""
    return model.add_body(position=(place[0], place[1], 0.0), rotation=(0.0, 0.0, turned), mass=mass,
                          centre=(centre, across, 0.0), inertia=(inertia, inertia, inertia, 0.0, 0.0, 0.0), **more)


def hinge(model, a, b, at, axis=(0.0, 0.0, 1.0), **more):
    """A revolute joint at a point of a, about z of a if no axis is given."""
    return model.add_joint(kind=mbd.JOINT_REVOLUTE, place_a=a, place_b=b, match=1, axis_a=axis, origin_a=at, **more)


# ---- Pendulum --------------------------------------------------------------------------------------------------------
def pendulum_closed(t, inertia=1e-6, length=1.0):
    """Angle from the horizontal, started at rest there: sin of half the angle from the bottom = k sn(K - w t), k^2 =
    1/2."""
    from scipy.special import ellipj, ellipk
    w = math.sqrt(GRAVITY * length / (length * length + inertia))
    sn = ellipj(ellipk(0.5) - w * np.asarray(t), 0.5)[0]
    return -0.5 * math.pi - 2.0 * np.arcsin(math.sqrt(0.5) * sn)


def pendulum_run(step, end=10.0):
    with planar() as model:
        bob = body(model, (-1.0, 0.0), 0.0, 1.0, 1e-6)
        hinge(model, GROUND, mbd.station(bob), (0.0, 0.0, 0.0))
        model.compile()
        with model.sim() as sim:
            sim.run(end, step)
            x, y, _ = sim.pose(mbd.station(bob)).position
            e = sim.energy()
            return x, y, e.kinetic + e.gravity


@case("pendulum")
def pendulum(pictures):
    angle = float(pendulum_closed(10.0))
    want, rows, steps, errors = (math.cos(angle), math.sin(angle)), [], (4e-3, 2e-3, 1e-3, 5e-4), []
    with planar() as model:
        body(model, (-1.0, 0.0), 0.0, 1.0, 1e-6)
        model.compile()
        with model.sim() as sim:
            start = sim.energy().gravity
    for step in steps:
        x, y, energy = pendulum_run(step)
        errors.append(math.hypot(x - want[0], y - want[1]))
        bound = 3e-5 * (step / 1e-3) ** 2
        rows += [Row("x at 10 s", "m", want[0], x, f"step {1e3 * step:g} ms", bound, 1.0),
                 Row("y at 10 s", "m", want[1], y, f"step {1e3 * step:g} ms", bound, 1.0),
                 Row("energy gained in 10 s (the benchmark's limit: 5e-5 J)", "J", 0.0, energy - start,
                     f"step {1e3 * step:g} ms", 5e-5 if step <= 1e-3 else None, 1.0)]
    def draw(axes):
        axes.loglog(1e3 * np.array(steps), errors, "o-", label="place at 10 s")
        axes.loglog(1e3 * np.array(steps), [errors[-1] * (step / steps[-1]) ** 2 for step in steps], ":",
                    label="second order")
        axes.set(xlabel="step [ms]", ylabel="error [m]")
        axes.legend()
    return Case("pendulum", "Simple pendulum", "published", BENCHMARKS.format("A01"), BENCHMARKS_DOI,
                "point mass of 1 kg on a massless rod of 1 m, from rest in the horizontal, 10 s; closed form by "
                "Jacobi's "
                "elliptic functions", "nothing", rows, pictures=[picture(draw)] if pictures else [])


# ---- N four-bar ------------------------------------------------------------------------------------------------------
def bars_reduced(windows, end=10.0):
    """Angle of the bars from the x axis by the one equation of motion: all uprights turn alike, couplers move with
    their ends. M phi'' = -g sum cos(phi), M = (N + 1)/3 + N, sum of heights (N + 1)/2 + N."""
    from scipy.integrate import solve_ivp
    inertia, height = (windows + 1) / 3.0 + windows, (windows + 1) / 2.0 + windows
    solution = solve_ivp(lambda _t, s: (s[1], -GRAVITY * height / inertia * math.cos(s[0])), (0.0, end),
                         (0.5 * math.pi, -1.0), method="DOP853", rtol=1e-12, atol=1e-13)
    return solution.y[0, -1]


def bars_run(windows, step, end=10.0):
    """Place of the top of the first upright at the end and the change of energy."""
    with planar() as model:
        uprights, slender = [], 1.0 / 12.0
        for k in range(windows + 1):
            upright = body(model, (k, 0.0), 0.5 * math.pi, 1.0, slender, 0.5, velocity=(0.0,) * 5 + (-1.0,))
            hinge(model, GROUND, mbd.station(upright), (k, 0.0, 0.0))
            uprights.append(upright)
        for k in range(windows):
            bar = body(model, (k, 1.0), 0.0, 1.0, slender, 0.5, velocity=(1.0, 0.0, 0.0, 0.0, 0.0, 0.0))
            for far, upright in enumerate(uprights[k:k + 2]):
                hinge(model, mbd.station(upright), mbd.station(bar), (1.0, 0.0, 0.0))
        model.compile()
        with model.sim() as sim:
            e = sim.energy()
            before = e.kinetic + e.gravity
            sim.run(end, step)
            e = sim.energy()
            x, y, _ = sim.pose_at(mbd.station(uprights[0]), (1.0, 0.0, 0.0)).position
            return x, y, e.kinetic + e.gravity - before


@case("four_bars")
def four_bars(pictures):
    rows, steps, errors = [], (2e-3, 1e-3, 5e-4), {}
    for windows, used in ((2, steps), (10, steps[:1])):
        angle = bars_reduced(windows)
        for step in used:
            x, y, gained = bars_run(windows, step)
            errors[windows, step] = math.hypot(x - math.cos(angle), y - math.sin(angle))
            bound = 2e-5 * (step / 1e-3) ** 2
            rows += [Row(f"{windows} windows: x of the first corner at 10 s", "m", math.cos(angle), x,
                         f"step {1e3 * step:g} ms", bound, 1.0),
                     Row(f"{windows} windows: y of the first corner at 10 s", "m", math.sin(angle), y,
                         f"step {1e3 * step:g} ms", bound, 1.0),
                     Row(f"{windows} windows: energy gained (the benchmark's limit: 0.1 J)", "J", 0.0, gained,
                         f"step {1e3 * step:g} ms", 0.1, 1.0)]
    def draw(axes):
        for windows in (2, 10):
            used = [step for step in steps if (windows, step) in errors]
            axes.loglog(1e3 * np.array(used), [errors[windows, step] for step in used], "o-",
                        label=f"{windows} windows")
        axes.set(xlabel="step [ms]", ylabel="error of the place at 10 s [m]")
        axes.legend()
    return Case("four_bars", "N four-bar mechanism through its singular positions", "published",
                BENCHMARKS.format("A02"),
                BENCHMARKS_DOI,
                "slender rods of 1 m and 1 kg, hinges along x on the ground, first corner at 1 m/s, 10 s; "
                "reference: the one equation of motion of the mechanism, solved by DOP853 at 1e-12", "nothing", rows,
                "All bars lie on one line twice a swing, where the mechanism could leave its branch.",
                pictures=[picture(draw)] if pictures else [])


# ---- Bricard's mechanism ---------------------------------------------------------------------------------------------
BRICARD_CORNERS = ((0, 0, 0), (1, 0, 0), (1, -1, 0), (1, -1, 1), (0, -1, 1), (0, 0, 1))
BRICARD_TURNED = ((0, 0, 0), (0, 0, -0.5), (0, -0.5, 0), (0, 0, 1), (0, 0, 0.5))  # [pi rad] of the rods, about one axis
BRICARD_AXES = ((0, 1, 0), (0, 0, 1), (1, 0, 0), (0, 1, 0), (0, 0, 1), (1, 0, 0))
#: Norm of the coordinates after 1 s by Exudyn in steps of 1 ms, less one degree of freedom and one redundant equation,
#: which are added there.
BRICARD_NORM = 4.172189649307425 - 2.0


def bricard_describe(model, start):
    """The rods, joined."""
    rods = [model.add_body(position=tuple(map(float, at)), rotation=tuple(turned.as_rotvec()), mass=1.0,
                           centre=(0.5, 0.0, 0.0), inertia=(1.0 / 600.0, 1.01 / 12.0, 1.01 / 12.0, 0.0, 0.0, 0.0))
            for at, turned in zip(BRICARD_CORNERS, start)]
    hinge(model, GROUND, mbd.station(rods[0]), (0.0, 0.0, 0.0), BRICARD_AXES[0])
    for k in range(1, 5):
        hinge(model, mbd.station(rods[k - 1]), mbd.station(rods[k]), (1.0, 0.0, 0.0),
              start[k - 1].inv().apply(BRICARD_AXES[k]))
    back = start[4].inv()
    model.add_joint(kind=mbd.JOINT_REVOLUTE, place_a=GROUND, place_b=mbd.station(rods[4]),
                    origin_a=BRICARD_CORNERS[5], axis_a=BRICARD_AXES[5], normal_a=(0.0, 1.0, 0.0),
                    origin_b=(1.0, 0.0, 0.0), axis_b=back.apply(BRICARD_AXES[5]), normal_b=back.apply((0.0, 1.0, 0.0)))
    model.compile()
    return rods


def bricard_run(step, end=1.0):
    """Norm of the displacements of the rods' first ends [m] and of the changes of their Euler parameters [-], change of
    energy, redundant equations."""
    from scipy.spatial.transform import Rotation
    start = [Rotation.from_rotvec(math.pi * np.array(turned)) for turned in BRICARD_TURNED]
    with planar() as model:
        rods, total = bricard_describe(model, start), 0.0
        with model.sim() as sim:
            before = sim.energy()
            sim.run(end, step)
            for rod, at, turned in zip(rods, BRICARD_CORNERS, start):
                pose = sim.pose(mbd.station(rod))
                angle = (turned.inv() * Rotation.from_matrix(np.reshape(pose.rotation, (3, 3)))).magnitude()
                total += sum((np.array(pose.position) - at) ** 2) + 4.0 * math.sin(0.25 * angle) ** 2
            after = sim.energy()
            gained = after.kinetic + after.gravity - before.kinetic - before.gravity
            return math.sqrt(total), gained, sim.statistics().redundant


@case("bricard")
def bricard(_pictures):
    rows = []
    for step in (1e-3, 5e-4):
        norm, gained, redundant = bricard_run(step)
        used = f"step {1e3 * step:g} ms"
        rows += [Row("norm of the coordinates after 1 s", "m, -", BRICARD_NORM, norm, used, 2e-6),
                 Row("energy gained in 1 s", "J", 0.0, gained, used, 1e-6, 1.0),
                 Row("redundant equations", "-", 1.0, redundant, used, 0.0, 1.0)]
    return Case("bricard", "Bricard's mechanism", "published",
                BENCHMARKS.format("A04") + "; digits: result stored in the test bricardMechanism.py of the public "
                "repository jgerstmayr/EXUDYN (30ec2d54), steps of 1 ms", BENCHMARKS_DOI,
                "five rods of 1 m, 1 kg and 0.1 m square, six hinges along the axes in turn, from rest, 1 s", "nothing",
                rows, "The norm is that of the displacements of the five first ends and of the changes of the Euler "
                "parameters; the stored result adds one degree of freedom and one redundant equation. Both codes are "
                "of second order: with 0.5 and 0.25 ms the norm here is 2.1721908 and 2.1721909, so that the stored "
                "digits end at the sixth.")


# ---- Andrews' squeezer -----------------------------------------------------------------------------------------------
ANDREWS_END = {"beta": 15.81077119629904, "gamma": 0.04082224013073101, "delta": 0.5244099658805304,
               "epsilon": 1.048080741042263}
ANDREWS_START = {"beta": -0.0617138900142764496, "theta": 0.0, "gamma": 0.455279819163070380,
                 "phi": 0.222668390165885884, "delta": 0.487364979543842550, "epsilon": 1.23054744454982119}


def squeezer(step, end=0.03):
    """Angles at the end by name."""
    a, b, c = (-0.06934, -0.00227), (-0.03635, 0.03273), (0.014, 0.072)
    q = ANDREWS_START
    omega = -q["phi"]
    with planar(0.0) as model:
        crank = body(model, (0.0, 0.0), q["beta"], 0.04325, 2.194e-6, 9.2e-4)
        pin = (7e-3 * math.cos(q["beta"]), 7e-3 * math.sin(q["beta"]))
        rod = body(model, pin, q["beta"] + q["theta"] + math.pi, 0.00365, 4.410e-7, 11.5e-3)
        triangle = body(model, b, q["gamma"], 0.02373, 5.255e-6, 18.74e-3, 10.43e-3)
        arm5 = body(model, a, q["delta"], 0.07050, 1.169e-5, 23.08e-3, 9.16e-3)
        e = (a[0] + 0.04 * math.cos(q["delta"]), a[1] + 0.04 * math.sin(q["delta"]))
        rod4 = body(model, e, q["phi"] + q["delta"] - 0.5 * math.pi, 0.00706, 5.667e-7, 0.02 - 0.01421)
        arm7 = body(model, a, q["epsilon"] - 0.5 * math.pi, 0.05498, 1.912e-5, 12.28e-3, 4.49e-3)
        h = (a[0] + 0.04 * math.sin(q["epsilon"]), a[1] - 0.04 * math.cos(q["epsilon"]))
        rod6 = body(model, h, omega + q["epsilon"], 0.00706, 5.667e-7, 0.02 - 0.01421)
        at = {name: mbd.station(part) for name, part in (("crank", crank), ("rod", rod), ("triangle", triangle),
                                                         ("arm5", arm5), ("rod4", rod4), ("arm7", arm7),
                                                         ("rod6", rod6))}
        joints = {"beta": hinge(model, GROUND, at["crank"], (0.0, 0.0, 0.0)),
                  "gamma": hinge(model, GROUND, at["triangle"], (*b, 0.0)),
                  "delta": hinge(model, GROUND, at["arm5"], (*a, 0.0)),
                  "epsilon": hinge(model, GROUND, at["arm7"], (*a, 0.0))}
        hinge(model, at["crank"], at["rod"], (7e-3, 0.0, 0.0))
        hinge(model, at["arm5"], at["rod4"], (0.04, 0.0, 0.0))
        hinge(model, at["arm7"], at["rod6"], (0.04, 0.0, 0.0))
        for end_of, length in (("triangle", None), ("rod4", 0.02), ("rod6", 0.02)):
            origin = (0.0, -35e-3, 0.0) if length is None else (length, 0.0, 0.0)
            model.add_joint(kind=mbd.JOINT_POINT_ON_LINE, place_a=at["rod"], place_b=at[end_of],
                            axis_a=(0.0, 0.0, 1.0), origin_a=(28e-3, 0.0, 0.0), origin_b=origin)
        model.add_spring(place_a=GROUND, place_b=at["triangle"], offset_a=(*c, 0.0), offset_b=(0.02, -0.018, 0.0),
                         free_length=0.07785, stiffness=4530.0)
        model.add_drive(kind=mbd.DRIVE_LOAD, part=joints["beta"], component=mbd.RX,
                        time_function=model.add_time_function(0.033))
        model.compile()
        with model.sim() as sim:
            shift = {name: q[name] - sim.joint(joint).position[3] for name, joint in joints.items()}
            sim.run(end, step)
            return {name: sim.joint(joint).position[3] + shift[name] for name, joint in joints.items()}


@case("squeezer")
def andrews(pictures):
    rows, steps, errors = [], (1e-5, 5e-6, 2.5e-6), []
    for step in steps:
        got = squeezer(step)
        errors.append(max(abs(got[name] - want) for name, want in ANDREWS_END.items()))
        for name, want in ANDREWS_END.items():
            rows.append(Row(f"{name} at 0.03 s", "rad", want, got[name], f"step {1e6 * step:g} µs",
                            2e-4 * (step / 1e-5) ** 2, 1.0))
    def draw(axes):
        axes.loglog(1e6 * np.array(steps), errors, "o-", label="largest of the four angles")
        axes.loglog(1e6 * np.array(steps), [errors[-1] * (step / steps[-1]) ** 2 for step in steps], ":",
                    label="second order")
        axes.set(xlabel="step [µs]", ylabel="error [rad]")
        axes.legend()
    return Case("squeezer", "Andrews' squeezing mechanism", "published",
                "Hairer, Wanner, Solving Ordinary Differential Equations II; digits at 0.03 s of the Test Set for IVP "
                "Solvers "
                "(PSIDE at 1e-14); also problem A03 of the library of multibody benchmarks",
                f"10.1007/978-3-642-05221-7, {BENCHMARKS_DOI}",
                "seven bodies, ten hinges, a spring of 4530 N/m, 0.033 N m at the crank, which turns 2.5 times in "
                "0.03 s",
                "nothing", rows, pictures=[picture(draw)] if pictures else [])


# ---- Flyball governor ------------------------------------------------------------------------------------------------
ROD, BALL, SLIDER = 0.3, 5.0, 3.0  # [kg] 1 x 0.01 x 0.01 m and 0.1 m cubed at 3000 kg/m3
SPRING, DAMPER, REST, RATE, START = 8e5, 4e4, 0.5, 2.0 * math.pi, math.pi / 3.0
ACROSS, ALONG, CUBE = ROD * (1.0 + 1e-4) / 12.0, ROD * 2e-4 / 12.0, SLIDER * 0.02 / 12.0  # [kg m2]


def governor_reduced(times):
    """Distance s [m] of the slider below the top by three equations: L = J(a) w constant, B a'' = J'(a) w^2/2 - V'(a) -
    2 F dl/da, m s'' = m g - 2 F dl/ds, with F = K (l - l0) + C l' and l^2 = (sin(a)/2)^2 + (s - cos(a)/2)^2."""
    from scipy.integrate import solve_ivp
    arms = 2.0 * (0.25 * ROD + ACROSS + BALL)

    def inertia(a):
        return ALONG + CUBE + arms * math.sin(a) ** 2 + 2.0 * ALONG * math.cos(a) ** 2
    momentum = inertia(START) * RATE

    def slope(_t, state):
        a, s, da, ds = state
        x, y = 0.5 * math.sin(a), s - 0.5 * math.cos(a)
        length = math.hypot(x, y)
        by_a, by_s = (x * 0.5 * math.cos(a) + y * 0.5 * math.sin(a)) / length, y / length
        force = SPRING * (length - REST) + DAMPER * (by_a * da + by_s * ds)
        turn = momentum / inertia(a)
        rise = (arms - 2.0 * ALONG) * math.sin(a) * math.cos(a) * turn ** 2
        weight = -2.0 * GRAVITY * (0.5 * ROD + BALL) * math.sin(a)
        return da, ds, (rise + weight - 2.0 * force * by_a) / arms, GRAVITY - 2.0 * force * by_s / SLIDER
    return solve_ivp(slope, (0.0, times[-1]), (START, REST, 0.0, 0.0), method="Radau", t_eval=times, rtol=1e-10,
                     atol=1e-12).y[1]


def governor_run(step, times):
    """The same by bodies: shaft, two rods with their balls, slider, two springs with dampers."""
    mass, centre = ROD + BALL, (0.5 * ROD + BALL) / (ROD + BALL)
    across = ACROSS + ROD * (centre - 0.5) ** 2 + BALL * (1.0 - centre) ** 2
    with mbd.Model() as model:
        model.set_environment(gravity=(0.0, 0.0, -GRAVITY))
        spinning = (0.0, 0.0, 0.0, 0.0, 0.0, RATE)
        shaft = model.add_body(mass=ROD, centre=(0.0, 0.0, -0.5), inertia=(ACROSS, ACROSS, ALONG, 0.0, 0.0, 0.0),
                               velocity=spinning)
        slider = model.add_body(mass=SLIDER, position=(0.0, 0.0, -REST), inertia=(CUBE, CUBE, CUBE, 0.0, 0.0, 0.0),
                                velocity=spinning)
        top, hung = mbd.station(shaft), mbd.station(slider)
        model.add_joint(kind=mbd.JOINT_REVOLUTE, place_a=GROUND, place_b=top, match=1, axis_a=(0.0, 0.0, 1.0))
        model.add_joint(kind=mbd.JOINT_PRISMATIC, place_a=top, place_b=hung, match=1, axis_a=(0.0, 0.0, 1.0))
        for turned in (0.5 * math.pi - START, 0.5 * math.pi + START):
            rod = model.add_body(mass=mass, centre=(centre, 0.0, 0.0), rotation=(0.0, turned, 0.0),
                                 inertia=(ALONG, across, across, 0.0, 0.0, 0.0),
                                 velocity=(0.0, 0.0, 0.0, -RATE * math.sin(turned), 0.0, RATE * math.cos(turned)))
            model.add_joint(kind=mbd.JOINT_REVOLUTE, place_a=top, place_b=mbd.station(rod), match=1,
                            axis_a=(0.0, 1.0, 0.0))
            model.add_spring(place_a=hung, place_b=mbd.station(rod), offset_b=(0.5, 0.0, 0.0), free_length=REST,
                             stiffness=SPRING, damping=DAMPER)
        model.compile()
        found = []
        with model.sim() as sim:
            for time in times:
                sim.run(time, step)
                found.append(-sim.pose(hung).position[2])
    return found


@case("governor")
def governor(pictures):
    times = [1.0, 2.0, 5.0, 10.0]
    want, rows = governor_reduced(times), []
    for step in (4e-3, 2e-3, 1e-3):
        for time, reference, computed in zip(times, want, governor_run(step, times)):
            rows.append(Row(f"distance of the slider at {time:g} s", "m", reference, computed,
                            f"step {1e3 * step:g} ms",
                            4e-4 * (step / 4e-3) ** 2, 1.0))
    fine = np.linspace(0.02, 10.0, 500)
    def draw(axes):
        axes.plot(fine, governor_reduced(fine), label="equations of motion")
        coarse = np.linspace(0.25, 10.0, 40)
        axes.plot(coarse, governor_run(2e-3, coarse), "o", markersize=3, label="computed, 2 ms")
        axes.set(xlabel="time [s]", ylabel="distance of the slider [m]")
        axes.legend()
    return Case("governor", "Stiff flyball governor", "published", BENCHMARKS.format("A05"), BENCHMARKS_DOI,
                "shaft, two rods of 1 m with balls of 5 kg, slider of 3 kg, springs of 8e5 N/m with dampers of 4e4 N "
                "s/m, "
                "2π rad/s, 10 s; reference: the three equations of motion, by Radau at 1e-10", "nothing", rows,
                pictures=[picture(draw)] if pictures else [])
