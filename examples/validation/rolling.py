"""A bicycle on knife-edge wheels: eigenvalues of its upright motion from the motion in time."""
import math

import numpy as np

import drillmbd as mbd
from case import Case, Row, case, picture

TILT = math.pi / 10.0  #: [rad] of the steering axis
#: Speed [m/s]: the eigenvalues [1/s] of table 2, those of positive imaginary part of pairs.
BENCHMARK = {0.0: (-5.53094371765393, -3.13164324790656, 3.13164324790656, 5.53094371765393),
             2.0: (-8.67387984831735, -3.07158645641514, 2.68234517512745 + 1.68066296590675j),
             4.0: (-12.15861426576450, -1.42944427361326, 0.41325331521125 + 3.07910818603206j),
             5.0: (-14.07838969279820, -0.77534188219585 + 4.46486771378823j, -0.32286642900409),
             6.0: (-16.08537123098030, -1.52644486584142 + 5.87673060598709j, -0.00406690076970),
             8.0: (-20.27940894394569, -2.69348683581097 + 8.46037971396931j, 0.14327879765713),
             10.0: (-24.62459635017404, -3.72016840437287 + 10.90681139476287j, 0.16105338653172)}
LEAN_RATE = 1e-4  #: [rad/s] at the start


def bicycle_run(speed, step, every, samples=50):
    """Lean, steer [rad] and their rates at `samples` times, `every` steps apart, from a small rate of lean."""
    with mbd.Model() as model:
        model.set_environment(gravity=(0.0, 0.0, -9.81))
        centres = {}

        def part(mass, centre, inertia, spin=0.0):
            (x, z), (xx, yy, zz, xz) = centre, inertia  # the benchmark's z points down: the product changes its sign
            body = model.add_body(mass=mass, position=(x, 0.0, z), inertia=(xx, yy, zz, 0.0, -xz, 0.0),
                                  velocity=(speed, -LEAN_RATE * z, 0.0, LEAN_RATE, spin, 0.0))
            centres[id(body)] = (x, z)
            return body

        def hinge(a, b, at, axis):
            x, z = centres[id(a)]
            return model.add_joint(kind=mbd.JOINT_REVOLUTE, place_a=mbd.station(a), place_b=mbd.station(b), match=1,
                                   axis_a=axis, origin_a=(at[0] - x, 0.0, at[1] - z))
        rear = part(2.0, (0.0, 0.3), (0.0603, 0.12, 0.0603, 0.0), speed / 0.3)
        frame = part(85.0, (0.3, 0.9), (9.2, 11.0, 2.8, 2.4))
        fork = part(4.0, (0.9, 0.7), (0.05892, 0.06, 0.00708, -0.00756))
        front = part(3.0, (1.02, 0.35), (0.1405, 0.28, 0.1405, 0.0), speed / 0.35)
        hinge(frame, rear, (0.0, 0.3), (0.0, 1.0, 0.0))
        steering = hinge(frame, fork, (1.1, 0.0), (-math.sin(TILT), 0.0, math.cos(TILT)))
        hinge(fork, front, (1.02, 0.35), (0.0, 1.0, 0.0))
        for wheel, radius in ((rear, 0.3), (front, 0.35)):
            model.add_joint(kind=mbd.JOINT_ROLLING, place_a=mbd.Place(), place_b=mbd.station(wheel), length=radius,
                            axis_a=(0.0, 0.0, 1.0), axis_b=(0.0, 1.0, 0.0))
        model.compile()
        table = []
        with model.sim(newton_tolerance=1e-12) as sim:
            for k in range(samples):
                if k:
                    sim.run(k * every * step, step)
                turned, steer = sim.pose(mbd.station(frame)).rotation, sim.joint(steering)
                table.append((math.atan2(turned[2, 1], turned[2, 2]), steer.position[3],
                              sim.motion(mbd.station(frame), mbd.FRAME_BODY).velocity[3], steer.speed[3]))
    return np.array(table)


def bicycle_roots(speed, step, interval=0.02):
    """[1/s] eigenvalues: x(t + h) = A x(t) of the four states by least squares over all samples, each over its size so
    that growing motions do not hide decaying ones; s = log(eig A)/h."""
    table = bicycle_run(speed, step, round(interval / step))
    scaled = table / np.abs(table).max(axis=0)
    size = np.linalg.norm(scaled[:-1], axis=1, keepdims=True)
    after = np.linalg.lstsq(scaled[:-1] / size, scaled[1:] / size, rcond=None)[0]
    roots = np.log(np.linalg.eigvals(after).astype(complex)) / interval
    return sorted((root for root in roots if root.imag > -1e-9), key=lambda root: root.real)


@case("bicycle")
def bicycle(pictures):
    rows, found = [], {}
    for step, bound in ((2e-3, 2.4e-4), (1e-3, 6e-5)):
        for speed, table in BENCHMARK.items():
            found[speed] = bicycle_roots(speed, step)
            for want, got in zip(table, found[speed]):
                parts = [("real", want.real, got.real)] + ([("imaginary", want.imag, got.imag)] if want.imag else [])
                for name, reference, computed in parts:
                    rows.append(Row(f"{speed:g} m/s: {name} part of the eigenvalue near {want.real:.3g}", "1/s",
                                    reference, computed,
                                    f"step {1e3 * step:g} ms", bound, max(1.0, abs(want))))
    def draw(axes):
        for speed in np.arange(0.0, 10.1, 0.5):
            roots = found.get(speed) or bicycle_roots(speed, 2e-3)
            axes.plot([speed] * len(roots), [root.real for root in roots], ".", color="C0", markersize=4)
            axes.plot([speed] * len(roots), [root.imag for root in roots], ".", color="C2", markersize=4)
        for speed, table in BENCHMARK.items():
            axes.plot([speed] * len(table), [complex(root).real for root in table], "o", color="C0", fillstyle="none")
            axes.plot([speed] * len(table), [complex(root).imag for root in table], "o", color="C2", fillstyle="none")
        axes.set(xlabel="speed [m/s]", ylabel="eigenvalue [1/s]", ylim=(-10.0, 11.0),
                 title="blue: real, green: imaginary parts; circles: published, points: computed")
    return Case("bicycle", "Bicycle on knife-edge wheels that roll without slip", "published",
                "Meijaard, Papadopoulos, Ruina, Schwab 2007, Proc. R. Soc. A 463, 1955, table 2 (fourteen digits)",
                "10.1098/rspa.2007.1857",
                "the benchmark bicycle: four bodies, three hinges, two rolling wheels (table 1)",
                "nothing", rows,
                "The bicycle is simulated over 1 s from a lean rate of 1e-4 rad/s; its eigenvalues are those of the "
                "linear map "
                "between samples 20 ms apart that fits the motion.", pictures=[picture(draw)] if pictures else [])
