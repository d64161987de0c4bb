#!/usr/bin/python3
"""The string of the rig falls on the low side of its hole: by the library and by a general finite element program.

usage: finite_elements.py          runs CalculiX (ccx, package calculix-ccx) and stores its motion in
                                   finite_elements.csv
"""
import csv
import math
import os
import pathlib
import subprocess
import tempfile
import time

import drillmbd as mbd
from case import Case, Row, case, picture

STORED = pathlib.Path(__file__).resolve().with_suffix(".csv")
PIPES, OUTER, INNER, CLEARANCE = 100, 0.073, 0.061, 0.0105  #: pipes of 1 m [m]
YOUNG, DENSITY, GRAVITY, STIFFNESS = 2.1e11, 7850.0, 9.80665, 1e7  #: [Pa], [kg/m3], [m/s2], [N/m] of the wall at a node
STEP, END = 5e-4, 0.1  #: [s]


def calculix_input():
    """Beams of two nodes, a gap element with a spring below each node, the first end clamped, gravity from the start.
    Of the solid square sections the bending stiffness and the mass are those of the pipe."""
    area, second = 0.25 * math.pi * (OUTER ** 2 - INNER ** 2), math.pi / 64.0 * (OUTER ** 4 - INNER ** 4)
    side = (12.0 * second) ** 0.25
    lines = ["*NODE"] + [f"{k + 1},{k}.,0.,0." for k in range(PIPES + 1)]
    lines += [f"{k + 10001},{k}.,0.,{-CLEARANCE}" for k in range(1, PIPES + 1)]
    lines += ["*ELEMENT, TYPE=B31, ELSET=PIPES"] + [f"{k},{k},{k + 1}" for k in range(1, PIPES + 1)]
    lines += ["*ELEMENT, TYPE=GAPUNI, ELSET=WALL"] + [f"{k + 5000},{k + 10001},{k + 1}" for k in range(1, PIPES + 1)]
    lines += ["*MATERIAL, NAME=STEEL", "*ELASTIC", f"{YOUNG},0.3", "*DENSITY", f"{DENSITY * area / side ** 2}",
              "*BEAM SECTION, ELSET=PIPES, MATERIAL=STEEL, SECTION=RECT", f"{side},{side}", "0.,1.,0.",
              "*GAP, ELSET=WALL",
              f"{CLEARANCE},0.,0.,1.,,{STIFFNESS},1.e-6", "*BOUNDARY", "1,1,6"]
    lines += [f"{k + 10001},1,3" for k in range(1, PIPES + 1)]
    lines += ["*STEP, NLGEOM, INC=100000", "*DYNAMIC, DIRECT, ALPHA=0.", f"{STEP},{END}", "*DLOAD",
              f"PIPES,GRAV,{GRAVITY},0.,0.,-1.", "*NSET, NSET=SHOWN", "51,81", "*NODE PRINT, NSET=SHOWN", "U",
              "*END STEP"]
    return "\n".join(lines) + "\n"


def calculix():
    """Times [s], heights [m] at 50 and 80 m, and seconds of processor a step."""
    with tempfile.TemporaryDirectory() as folder:
        pathlib.Path(folder, "drop.inp").write_text(calculix_input(), encoding="ascii")
        before = os.times()
        subprocess.run(["ccx", "drop"], cwd=folder, check=True, stdout=subprocess.DEVNULL,
                       env={**os.environ, "OMP_NUM_THREADS": "1"})
        after = os.times()
        table, now = [], {}
        for line in pathlib.Path(folder, "drop.dat").read_text(encoding="ascii").splitlines():
            words = line.split()
            if "time" in words:
                now = {"time": float(words[-1])}
                table.append(now)
            elif words:
                now[words[0]] = float(words[3])
    spent = after.children_user + after.children_system - before.children_user - before.children_system
    return [(row["time"], row["51"], row["81"]) for row in table], spent / len(table)


def library():
    """The same by the library."""
    with mbd.Model() as model:
        model.set_environment(gravity=(0.0, 0.0, -GRAVITY))
        model.add_wall(diameter=OUTER + 2.0 * CLEARANCE, direction=(1.0, 0.0, 0.0), mu_static=0.0, mu_dynamic=0.0,
                       normal_law=mbd.NORMAL_KELVIN_VOIGT, damping=0.0, stiffness=STIFFNESS)
        string = model.add_string(start_free=mbd.FREE_NONE)
        model.add_pipes(PIPES, string=string, length=1.0, outer_diameter=OUTER, inner_diameter=INNER,
                        young_modulus=YOUNG,
                        density=DENSITY)
        model.compile()
        table, spent = [], 0.0
        with model.sim(spectral_radius=1.0) as sim:
            for _ in range(round(END / STEP)):
                before = time.process_time()
                sim.step(STEP)
                spent += time.process_time() - before
                table.append((sim.time, *(sim.pose(mbd.station(string, pipe, 1.0)).displacement[2]
                                          for pipe in (49, 79))))
    return table, spent / len(table)


@case("finite_elements")
def finite_elements(pictures):
    with open(STORED, encoding="utf-8", newline="") as text:
        stored = list(csv.reader(text))
    costs = [float(value) for value in stored[0][1:3]]
    theirs, (ours, _) = [tuple(map(float, row)) for row in stored[2:]], library()
    rows = []
    for when in (0.02, 0.045, 0.05, 0.06, 0.08, 0.1):
        k = round(when / STEP) - 1
        for column, where in ((1, 50), (2, 80)):
            rows.append(Row(f"height at {where} m after {when:g} s, over the clearance", "mm", 1e3 * theirs[k][column],
                            1e3 * ours[k][column], "100 elements, 0.5 ms", 0.01, 1e3 * CLEARANCE))
    def draw(axes):
        axes.plot([row[0] for row in ours], [1e3 * row[1] for row in ours], "-", color="C0", label="computed, 50 m")
        axes.plot([row[0] for row in theirs[::4]], [1e3 * row[1] for row in theirs[::4]], "o", color="C3", markersize=3,
                  label="CalculiX, 50 m")
        axes.axhline(-1e3 * CLEARANCE, color="#888888", linestyle=":")
        axes.set(xlabel="time [s]", ylabel="height over the axis [mm]")
        axes.legend()
    return Case("finite_elements", "The rig's string in its hole by a general finite element program", "published",
                "CalculiX 2.20 (Dhondt, Wittig), run by examples/validation/finite_elements.py; its motion is stored "
                "beside it", "",
                "100 pipes of 1 m, 73 x 6 mm, clamped at the rig, in a level hole of 94 mm; from rest on the axis "
                "under gravity; wall of "
                "1e7 N/m at each node, no damping, no friction, no rotation (gap elements have no friction); one "
                "element a "
                "pipe and steps of 0.5 ms in both", "nothing", rows,
                "Cost of a step on one core, both measured one after the other when the motion was stored: CalculiX "
                f"{1e3 * costs[0]:.0f} ms, the "
                f"library {1e6 * costs[1]:.0f} µs: {costs[0] / costs[1]:.0f} times less. CalculiX expands its beams to "
                "solids and iterates twice a "
                "step; a beam code of finite elements would be cheaper than that.",
                pictures=[picture(draw)] if pictures else [])


def main():
    """Runs both and stores the motion of CalculiX and the costs."""
    (motion, slow), (_, fast) = calculix(), library()
    with open(STORED, "w", encoding="utf-8", newline="") as text:
        writer = csv.writer(text, lineterminator="\n")
        writer.writerow(("seconds of processor a step: CalculiX, library", f"{slow:.3g}", f"{fast:.3g}"))
        writer.writerow(("time [s]", "height at 50 m [m]", "height at 80 m [m]"))
        writer.writerows((f"{t:.6g}", f"{a:.6e}", f"{b:.6e}") for t, a, b in motion)
    print(f"CalculiX {1e3 * slow:.3g} ms, library {1e6 * fast:.3g} us a step of {len(motion)}: {STORED}")


if __name__ == "__main__":
    main()
