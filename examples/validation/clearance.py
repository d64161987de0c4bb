"""A string without bending stiffness that hangs in a hole wider than itself: how much of the wall forces of a soft
string, which follows the axis of the hole, is left."""
import math
import tomllib

import numpy as np

GRAVITY = 9.81


def pieces(path, density, longest=10.0):
    """Lengths [m], weights in mud [N/m] and outer diameters [m] of pieces of the pipes of a scene file, from the rig
    down."""
    def number(text):
        return float(text.split()[0])
    table = []
    for pipe in tomllib.loads(path.read_text(encoding="utf-8"))["string"][0]["pipes"]:
        length, count = number(pipe["length"]), pipe["count"]
        outer, inner = (1e-3 * number(pipe[side + "_diameter"]) for side in ("outer", "inner"))
        weight = GRAVITY * (number(pipe["section_mass"]) - density * 0.25 * math.pi * (outer ** 2 - inner ** 2))
        parts = max(1, round(length / longest))
        table += [(length / parts, weight, outer)] * (count * parts)
    return np.array(table).T


def wall_forces(sim, lengths, weights, outers, sweeps=500):
    """Lateral load [N] of the wall, friction factor and radius [m] of the string at the ends of the pieces, without
    friction.

    The string has the energy sum T |r_(i+1) - r_i| + w z with the tensions T of its hanging weight, dT = w dz. Its
    nodes move across the hole, |u_i| <= clearance, and each in turn goes to its least energy (projected Gauss-Seidel,
    even and odd nodes by turns); the wall bears what is left."""
    depths = np.concatenate([[0.0], np.cumsum(lengths)])
    holes = [sim.hole(depth) for depth in depths]
    axis, along = (np.array([list(getattr(hole, name)) for hole in holes]) for name in ("position", "tangent"))
    outer = np.maximum(np.append(outers, 0.0), np.insert(outers, 0, 0.0))
    clearance = 0.5 * (np.array([hole.diameter for hole in holes]) - outer)
    weight = np.append(0.5 * weights * lengths, 0.0) + np.insert(0.5 * weights * lengths, 0, 0.0)
    gained = weights * (axis[:-1, 2] - axis[1:, 2])
    stiff = (np.cumsum(gained[::-1])[::-1] - 0.5 * gained) / lengths  # T/l of each piece
    count = len(depths)
    place, load = axis.copy(), np.zeros(count)
    for _ in range(sweeps):
        for nodes in (np.arange(1, count, 2), np.arange(2, count, 2)):
            after = np.minimum(nodes + 1, count - 1)
            above, below = stiff[nodes - 1], np.where(nodes < count - 1, stiff[after - 1], 0.0)
            force = above[:, None] * (place[nodes - 1] - place[nodes]) + below[:, None] * (place[after] - place[nodes])
            force[:, 2] -= weight[nodes]
            force -= np.sum(force * along[nodes], axis=1)[:, None] * along[nodes]
            wanted = place[nodes] - axis[nodes] + force / (above + below)[:, None]
            size = np.linalg.norm(wanted, axis=1)
            held = np.minimum(1.0, clearance[nodes] / np.maximum(size, 1e-12))
            load[nodes] = (1.0 - held) * size * (above + below)
            place[nodes] = axis[nodes] + held[:, None] * wanted
    return load, np.array([hole.mu_dynamic for hole in holes]), 0.5 * outer
