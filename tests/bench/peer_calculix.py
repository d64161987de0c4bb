#!/usr/bin/python3
"""CalculiX on cantilevers, and the library on the same. usage: peer_calculix.py CSV LIBRARY

The tube of scenes A to C, 100 m, clamped at one end and free at the other:
  A         its first five pairs of bending frequencies, against Euler-Bernoulli
  sag       tip deflection under a small transverse tip force, against P L^3/3EI
  elastica  the same under P = 10 EI/L^2, against Mattiasson 1981
  bending   the small force put on at once, 150 s (a period of the first mode) in equal steps, tip deflection at every
            step against the sum over modes; root of the mean square over that of the reference

It does not compute scenes C and B: see NOTEBOOK.md. Times: of CalculiX, processor time of the whole
program from deck to result, one thread; of the library, from the first call of the description to the result.
"""
import csv
import ctypes
import math
import os
import pathlib
import re
import resource
import shutil
import statistics
import subprocess
import sys
import tempfile
import time

os.environ["OMP_NUM_THREADS"] = os.environ["OPENBLAS_NUM_THREADS"] = "1"

LENGTH, OUTER, INNER = 100.0, 0.073, 0.059
YOUNG, POISSON, DENSITY = 206e9, 0.3, 7850.0
BENDING = YOUNG * math.pi / 64 * (OUTER**4 - INNER**4)
LINE_MASS = DENSITY * math.pi / 4 * (OUTER**2 - INNER**2)
SMALL_FORCE = 3 * BENDING * 0.1 / LENGTH**3  # a tip deflection of 0.1 m
LARGE_FORCE = 10 * BENDING / LENGTH**2
ELASTICA = 0.8106090249 * LENGTH  # Mattiasson 1981
PERIOD = 150.0

COLUMNS = ("scene,elements,dt,us_per_step,U_per_step,rtf,iterations,error,error_kind,code,version,setting,end,steps,"
           "U_us,U_per_simulated_second,residuals,tangents,error_2,error_2_kind").split(",")  # as in peer_rows.h


# ---- Closed forms ----------------------------------------------------------------------------------------------------
def clamped_free_root(n):
    """n-th root of cos x cosh x = -1, by Newton on cos x + 1/cosh x."""
    x = (n - 0.5) * math.pi
    for _ in range(20):
        x -= (math.cos(x) + 1 / math.cosh(x)) / (-math.sin(x) - math.tanh(x) / math.cosh(x))
    return x


OMEGA = [clamped_free_root(n)**2 * math.sqrt(BENDING / (LINE_MASS * LENGTH**4)) for n in range(1, 31)]


def tip_under_step_force(t):
    """A modal mass is a quarter of the beam's where the tip moves by 1."""
    return sum(4 * SMALL_FORCE / (LINE_MASS * LENGTH * w * w) * (1 - math.cos(w * t)) for w in OMEGA)


def frequency_error(pairs):
    """Largest relative error of the five pairs, both of each."""
    return max(abs(2 * math.pi * f / OMEGA[i // 2] - 1) for i, f in enumerate(pairs[:10]))


def history_error(history):
    """history: pairs (time, tip deflection)"""
    reference = [tip_under_step_force(t) for t, _ in history]
    difference = sum((w - r)**2 for (_, w), r in zip(history, reference))
    return math.sqrt(difference / sum(r * r for r in reference))


# ---- Yardstick -------------------------------------------------------------------------------------------------------
def yardstick():
    """[s] U, as in yardstick.h; NaN without LAPACKE."""
    try:
        library = ctypes.CDLL("liblapacke.so.3")
    except OSError:
        return math.nan
    n, band = 606, 11
    entries = [30.0 if k == 0 else math.sin(1.0 + column + 7.0 * k) for column in range(n) for k in range(band + 1)]
    taken = []
    for _ in range(101):
        matrix, x = (ctypes.c_double * len(entries))(*entries), (ctypes.c_double * n)(*[1.0] * n)
        begin = time.thread_time()
        library.LAPACKE_dpbtrf(102, ctypes.c_char(b"L"), n, band, matrix, band + 1)
        library.LAPACKE_dpbtrs(102, ctypes.c_char(b"L"), n, band, 1, matrix, band + 1, x, n)
        taken.append(time.thread_time() - begin)
    return statistics.median(taken)


# ---- CalculiX --------------------------------------------------------------------------------------------------------
STEPS = {
    "A": "*STEP\n*FREQUENCY\n10\n",
    "sag": "*STEP\n*STATIC\n",
    "elastica": "*STEP,NLGEOM,INC=1000\n*STATIC\n0.1,1.\n",
    "bending": "*STEP,INC=1000000\n*DYNAMIC,DIRECT\n{step},{period}\n",
    "superposed": "*STEP\n*FREQUENCY,STORAGE=YES\n20\n*END STEP\n"
                  "*STEP,INC=1000000\n*MODAL DYNAMIC\n{step},{period}\n",
}


def deck(case, elements, step):
    """B32R: quadratic beam of reduced integration, the only kind with a pipe section; expanded into a solid."""
    tip = 2 * elements + 1
    lines = ["*NODE,NSET=ALL"]
    lines += [f"{i + 1},{LENGTH * i / (2 * elements):.15g},0,0" for i in range(tip)]
    lines += ["*ELEMENT,TYPE=B32R,ELSET=TUBE"]
    lines += [f"{e + 1},{2 * e + 1},{2 * e + 2},{2 * e + 3}" for e in range(elements)]
    lines += ["*MATERIAL,NAME=STEEL", "*ELASTIC", f"{YOUNG},{POISSON}", "*DENSITY", f"{DENSITY}"]
    lines += ["*BEAM SECTION,ELSET=TUBE,MATERIAL=STEEL,SECTION=PIPE", f"{OUTER / 2},{(OUTER - INNER) / 2}", "0,1,0"]
    lines += ["*BOUNDARY", "1,1,6", "*NSET,NSET=TIP", f"{tip}"]
    lines += [STEPS[case].format(step=step, period=PERIOD).rstrip()]
    if case != "A":
        force = LARGE_FORCE if case == "elastica" else SMALL_FORCE
        lines += ["*CLOAD", f"{tip},3,{force!r}", "*NODE PRINT,NSET=TIP", "U"]
    return "\n".join(lines + ["*END STEP"]) + "\n"


def run_calculix(text, folder):
    """[s] of processor time, and the .dat file; None where it failed."""
    (folder / "job.inp").write_text(text, encoding="ascii")
    (folder / "job.dat").unlink(missing_ok=True)
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    done = subprocess.run(["ccx", "-i", "job"], cwd=folder, capture_output=True, check=False)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    seconds = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
    if done.returncode != 0 or b"*ERROR" in done.stdout:
        return seconds, None
    return seconds, (folder / "job.dat").read_text(encoding="ascii")


def tips(dat):
    """Pairs (time, z) of the tip."""
    found = re.findall(r"and time\s+(\S+)\s+\d+\s+\S+\s+\S+\s+(\S+)", dat)
    return [(float(t), float(z)) for t, z in found]


def solve_calculix(case, elements, step, folder):
    seconds, dat = run_calculix(deck(case, elements, step), folder)
    if dat is None:
        return seconds, 0, math.nan
    if case == "A":
        rows = re.findall(r"^ +\d+ +\S+ +\S+ +(\S+) +\S+$", dat, re.MULTILINE)
        return seconds, 1, frequency_error([float(f) for f in rows])
    history = tips(dat)
    if case in ("bending", "superposed"):
        return seconds, len(history), history_error(history)
    reference = ELASTICA if case == "elastica" else 0.1
    return seconds, len(history), abs(history[-1][1] / reference - 1)


# ---- The library -----------------------------------------------------------------------------------------------------
def cantilever(mbd, elements, force):
    model = mbd.Model()
    model.set_environment(gravity=(0.0, 0.0, 0.0))
    string = model.add_string(start_free=mbd.FREE_NONE)
    model.add_pipes(1, string=string, elements=elements, length=LENGTH, outer_diameter=OUTER, inner_diameter=INNER,
                    young_modulus=YOUNG, poisson_ratio=POISSON, density=DENSITY)
    tip = mbd.station(string, 0, 1.0)
    if force:
        model.add_load(place=tip, force=(0.0, 0.0, force))
    model.compile()
    return model, tip


def solve_library(mbd, case, elements, step):
    begin = time.process_time()
    forces = {"A": 0.0, "elastica": LARGE_FORCE}
    model, tip = cantilever(mbd, elements, forces.get(case, SMALL_FORCE))
    with model.sim(energy_ledger=0) as sim:
        if case == "A":
            error = frequency_error([mode.frequency for mode in sim.modes(count=10)])
            return time.process_time() - begin, 1, error
        if case == "bending":
            history = []
            for _ in range(round(PERIOD / step)):
                sim.step(step)
                history.append((sim.time, sim.pose(tip).position[2]))
            seconds = time.process_time() - begin
            return seconds, len(history), history_error(history)
        report = sim.static()
        deflection = sim.pose(tip).position[2]
    reference = ELASTICA if case == "elastica" else 0.1
    return time.process_time() - begin, report.iterations, abs(deflection / reference - 1)


# ---- Rows ------------------------------------------------------------------------------------------------------------
KINDS = {"A": "frequency_vs_euler_bernoulli", "sag": "tip_vs_PL3_3EI", "elastica": "tip_vs_mattiasson",
         "bending": "tip_history_vs_modes"}


def report(table, unit, code, version, case, elements, setting, result):
    seconds, steps, error = result
    if math.isnan(error):
        print(f"scene={case} elements={elements} code={code} setting={setting} failed=after_{seconds:.2f}_s",
              flush=True)
        return
    row = dict.fromkeys(COLUMNS, "")
    row.update(code=code, version=version, scene=case, elements=elements, setting=setting, steps=steps,
               us_per_step=f"{1e6 * seconds / steps:.5g}", U_us=f"{1e6 * unit:.4g}",
               U_per_step=f"{seconds / steps / unit:.5g}", error=f"{error:.3g}", error_kind=KINDS[case],
               error_2_kind="-")
    if case == "bending":
        row.update(end=PERIOD, dt=f"{PERIOD / steps:.4g}", rtf=f"{PERIOD / seconds:.4g}",
                   U_per_simulated_second=f"{seconds / PERIOD / unit:.5g}")
    table.writerow(row)
    print(" ".join(f"{name}={value}" for name, value in row.items() if value != "" or name in COLUMNS[:9])
          .replace("= ", "=- "), flush=True)


def calculix_version():
    text = subprocess.run(["ccx", "-v"], capture_output=True, check=False, text=True).stdout
    return re.search(r"Version\s+(\S+)", text).group(1)


def main():
    if len(sys.argv) != 3:
        sys.exit("usage: peer_calculix.py CSV LIBRARY")
    if not shutil.which("ccx"):
        sys.exit("peer_calculix: skipped, no ccx here")
    os.environ["DRILLMBD_LIBRARY"] = sys.argv[2]
    sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "bindings" / "python"))
    import drillmbd as mbd
    version, unit = calculix_version(), yardstick()
    own = ".".join(str(part) for part in mbd.VERSION)
    with open(sys.argv[1], "w", encoding="ascii", newline="") as text, tempfile.TemporaryDirectory() as folder:
        table = csv.DictWriter(text, COLUMNS, lineterminator="\n")
        table.writeheader()
        def both(case, elements, step, setting):
            result = solve_calculix(case, elements, step, pathlib.Path(folder))
            report(table, unit, "CalculiX", version, case, elements, setting, result)
            result = solve_library(mbd, case, elements, step)
            report(table, unit, "drillmbd", own, case, elements, setting, result)

        for elements in (10, 20, 50, 100):
            both("A", elements, 0.0, "modes")
        for case in ("sag", "elastica"):
            for elements in (10, 20, 50, 100):
                both(case, elements, 0.0, "static")
        for elements in (20, 100):
            for step in (1.0, 0.25):
                both("bending", elements, step, f"dt={step:g}")
        result = solve_calculix("superposed", 20, 0.25, pathlib.Path(folder))  # *MODAL DYNAMIC; 2.20 aborts
        report(table, unit, "CalculiX", version, "bending", 20, "dt=0.25;modes=20", result)
        for step in (0.0625, 0.015625):  # what is left of the error is the element's
            result = solve_library(mbd, "bending", 100, step)
            report(table, unit, "drillmbd", own, "bending", 100, f"dt={step:g}", result)


if __name__ == "__main__":
    main()
