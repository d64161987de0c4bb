#!/usr/bin/python3
"""Tables and goals of the benchmark. usage: table.py [--fill README.md] FOLDER SCENE...

Reads FOLDER/SCENE.csv, writes the tables of these scenes to FOLDER/tables.md, and prints each goal with what was
measured. --fill puts the tables, shortened, where all of their scenes were given, between the lines
"<!-- table NAME -->" and "<!-- end -->" of a file.
"""
import math
import pathlib
import re
import sys

import rows as measured
from rows import chosen

SIZES = ("100", "200", "400", "1000", "10000")


def number(text, digits=3):
    """Three significant digits, no exponent between 1e-3 and 1e6."""
    if text in ("", "-", None):
        return "-"
    value = float(text)
    if value == 0.0:
        return "0"
    if not 1e-3 <= abs(value) < 1e6:
        return f"{value:.1e}".replace("e-0", "e-").replace("e+0", "e")
    return f"{value:.{max(0, digits - 1 - math.floor(math.log10(abs(value))))}f}"


def percent(text):
    return f"{100 * float(text):.1f} %" if text else "-"


def error(row):
    """Error and, where there is one, the second with its unit."""
    second = row.get("error_2", "")
    unit = " mm" if "_mm" in row.get("error_2_kind", "") else ""
    return number(row["error"], 2) + (f", {number(second, 2)}{unit}" if second else "")


def markdown(columns, lines):
    return "\n".join(["| " + " | ".join(columns) + " |", "|" + "---|" * len(columns)] +
                     ["| " + " | ".join(line) + " |" for line in lines])


def exponent(rows, size, cost):
    """Slope of log(cost) over log(size) by least squares, and the standard error of the slope."""
    x = [math.log(float(row[size])) for row in rows]
    y = [math.log(float(row[cost])) for row in rows]
    n, mean_x, mean_y = len(x), sum(x) / len(x), sum(y) / len(y)
    spread = sum((u - mean_x) ** 2 for u in x)
    slope = sum((u - mean_x) * (v - mean_y) for u, v in zip(x, y)) / spread
    rest = sum((v - mean_y - slope * (u - mean_x)) ** 2 for u, v in zip(x, y))
    return slope, math.sqrt(rest / max(1, n - 2) / spread)


def iteration_exponent(rows):
    """The same of the cost of an iteration over the elements."""
    return exponent([row | {"us": float(row["us_per_step"]) / float(row["iterations"])} for row in rows], "elements",
                    "us")[0]


# ---- Tables ----------------------------------------------------------------------------------------------------------


def machine(data, cards):
    units = [float(row["U_us"]) for rows in data.values() for row in rows if row.get("U_us")]
    lines = [[name, text] for name, text in cards.items() if name not in ("times", "commit")]
    return markdown(["machine", ""],
                    lines + [["U", f"{min(units):.1f} to {max(units):.1f} us, taken beside every row"]])


def elements(data):
    names = {"elements": "", "steps": "", "given": "", "axial_torsional": ", axial-torsional", "cycle": ", whole cycle",
             "long": ", 1000 pipes", "ledger": ", no ledger"}
    lines = []
    for scene in ("C", "B", "R"):
        rows = data.get(scene, [])
        for group in names:
            for row in chosen(rows, group=group):
                step = "" if row["dt"] == "0.001" else f", {1e3 * float(row['dt']):g} ms"
                lines.append([row["scene"] + names[group] + step, row["elements"], row["end"],
                              number(row["us_per_step"]), percent(row["spread"]), number(row["U_us"]),
                              number(row["U_per_step"]), number(row["rtf"]), number(row["iterations"]),
                              row["rejected"], error(row), number(row["balance"], 2),
                              number(row["bytes_per_element"], 4)])
    return markdown(["scene", "elements", "end s", "us a step", "spread", "U us", "U a step", "rtf", "iterations",
                     "rejected", "error", "balance", "bytes an element"], lines)


def growth(data):
    lines = []
    for scene in ("C", "B", "R"):
        rows = chosen(data.get(scene, []), group="growth")
        if not rows:
            continue
        slope, off = exponent(rows, "elements", "us_per_step")
        each = iteration_exponent(rows)
        lines.append([scene, rows[0]["end"]] +
                     [f"{number(row['us_per_step'])} ({number(row['iterations'])})" for row in rows] +
                     [" ".join(number(row["error"], 2) for row in rows), f"{slope:.3f} +- {off:.3f}", f"{each:.3f}"])
    return markdown(["scene", "end s"] + [f"us at {size}" for size in SIZES] +
                    ["errors", "exponent", "of an iteration"], lines)


# Other open codes on scenes C and B in one run on one machine (AMD EPYC, U 47.6 to 51.8 us): one thread, process time,
# set-up excluded, steps of 1 ms, 2 s, 100 elements, median of three turns in alternation. Error of C: tip rotation at 2
# s
# against d'Alembert; of B: against 9.3755 rad.
OTHERS = [
    ("C", "libdrillmbd", 14.1, "1.0e-6", "defaults, energy ledger on"),
    ("C", "MBDyn, develop 59e50fa", 186.0, "1.1e-6", "-Ofast -march=native, naive solver with colamd, modified Newton, "
     "Jacobian kept for 100 iterations, tolerance 1e-4"),
    ("C", "Exudyn 1.11.0", 246.0, "1.1e-6",
     "fast module, sparse LU, modified Newton, rtol 1e-4, Tait-Bryan nodes, spectral "
     "radius 0.8"),
    ("B", "libdrillmbd", 54.3, "4.9e-5", "defaults, Newton tolerance 1e-8"),
    ("B", "MBDyn, develop 59e50fa", 408.0, "3.6e-5",
     "as above, modified Newton 5, tolerance 1e-2, at most 10 iterations, then "
     "accepted; wall contact as a user module in C++"),
    ("B", "Exudyn 1.11.0", 759.0, "3.9e-4",
     "sphere contacts, rtol = atol = 1e-3, recommended step size off; its friction law is "
     "linear below 0.01 m/s"),
]


def others(data):
    """Figures of other open codes beside ours of the same run, each with its error and its settings."""
    ours = {scene: us for scene, code, us, _, _ in OTHERS if code == "libdrillmbd"}
    return markdown(["scene", "code", "us a step", "over ours", "error", "settings"],
                    [[scene, code, number(us), number(us / ours[scene]) if us != ours[scene] else "1", error_text,
                      settings]
                     for scene, code, us, error_text, settings in OTHERS])


def pipes(data):
    lines = []
    for scene in ("C", "R"):
        for row in chosen(data.get(scene, []), group="pipes"):
            lines.append([scene, row["pipes"], number(row["us_per_step"]), number(row["U_per_step"]),
                          number(row["rtf"]), number(row["iterations"]), error(row)])
    return markdown(["scene", "pipes", "us a step", "U a step", "rtf", "iterations", "error"], lines)


def joints(data):
    lines = [[row["joints"], row["rows"], row["method"], number(row["us_describe"]), number(row["us_compile"]),
              number(row["us_create"]), number(row["us_create_per_joint"]), number(row["us_per_step"]),
              percent(row["spread"]), number(row["us_per_step_per_joint"]), number(row["U_per_step"]),
              number(row["to_structural"]), number(row["error"], 2), row["bytes_per_joint"]] for row in data["J"]]
    growths = [[method] + [f"{exponent(chosen(data['J'], method=method), 'joints', name)[0]:.3f}"
                           for name in ("us_describe", "us_compile", "us_create", "us_per_step")]
               for method in ("independent", "multipliers", "structural")]
    return markdown(["joints", "rows", "as", "describe us", "compile us", "create us", "a joint", "step us", "spread",
                     "a joint", "U", "to one string", "error", "bytes a joint"], lines) + "\n\n" + \
        markdown(["exponents over the joints", "describe", "compile", "create", "step"], growths)


def clusters(data):
    lines = [[row["elements"], row["kind"].replace("_", ", "), row["rows"], row["redundant"], number(row["us_compile"]),
              number(row["us_create"]), number(row["us_per_step"]), percent(row["spread"]),
              number(row["us_per_step_per_body"]), number(row["U_per_step"]), number(row["to_plain"]),
              number(row["iterations"]), number(row["error"], 2), row["bytes_per_body"]] for row in data["K"]]
    growths = [[kind.replace("_", ", "), f"{slope:.3f} +- {off:.3f}"]
               for kind in ("chain", "tree", "loops", "loops_redundant")
               for slope, off
               in [exponent([row for row in chosen(data["K"], kind=kind) if float(row["elements"]) >= 10],
                            "elements", "us_per_step")]]
    return markdown(["bodies", "as", "rows", "redundant", "compile us", "create us", "step us", "spread", "a body", "U",
                     "to loops without", "iterations", "error", "bytes a body"], lines) + "\n\n" + \
        markdown(["from 10 bodies on", "exponent of a step over the bodies"], growths)


def loaded(data):
    lines = [[row["load"].replace("_", " "), row["elements_per_pipe"], number(row["error"], 2),
              number(row["error_2"], 2),
              number(row["us_per_step"]), number(row["U_per_step"]), percent(row["spread"]), number(row["iterations"])]
             for row in data["N"]]
    return markdown(["load", "elements a pipe", "deflection", "frequencies", "us a step", "U", "spread", "iterations"],
                    lines)


def loop(data):
    times, results = [], []
    for row in data["D"]:
        times.append([row["variant"], number(row["U_us"])] + [number(row[f"us_{q}"]) for q in
                                                              ("median", "99", "99.9", "largest")] +
                     [", ".join(number(row[f"U_{q}"]) for q in ("median", "99", "99.9", "largest")),
                      number(row["of_step_99.9"]), number(row["of_step_largest"]),
                      f"{row['most_iterations']} in {row['worst_steps']}, {row['worst_rejected']}",
                      number(row["iterations"]), row["rejected"], row["limited"]])
        results.append([row["variant"]] + [number(row[f"residual_{q}"], 2) for q in ("median", "99", "largest")] +
                       [number(row["error"], 3), number(row["rotation_to_plain"], 2),
                        number(row["end_rotation_to_plain"], 2), number(row["wall_force_to_plain"], 2),
                        number(row["balance"], 2), number(row["wall_us_99.9"]),
                        f"{row['wall_late']} of {row['wall_steps']}"])
    return markdown(["loop", "U us", "median us", "99 %", "99.9 %", "largest", "in U", "99.9 % of the step",
                     "largest of it", "worst: iterations in steps, rejected", "iterations", "rejected", "limited"],
                    times) + "\n\n" + \
        markdown(["loop", "residual median", "99 %", "largest", "error", "rotation to plain", "at 4 s",
                  "wall force to plain", "balance", "wall clock 99.9 % us", "late by it"], results)


def features(data):
    lines = [[row["variant"], number(row["us_per_step"]), percent(row["spread"]), number(row["U_us"]),
              number(row["U_per_step"]), number(row["iterations"]), row["sim_bytes"],
              number(row["sim_bytes_per_pipe"], 4), row["model_bytes"],
              f"{number(row['error'], 2)}, {row['error_kind'].split('_vs_')[0].replace('_', ' ')}",
              number(row["balance"], 2)] for row in data["F"]]
    return markdown(["compiled", "us a step", "spread", "U us", "U a step", "iterations", "sim bytes", "a pipe",
                     "model bytes", "error", "balance"], lines)


def at_step(rows, step):
    found = [row for row in rows if abs(float(row["dt"]) / step - 1) < 1e-3]
    return number(found[0]["error"], 2) if found else "-"


def fixed_work(rows, wanted):
    """Work of fixed steps at that error, between its two neighbours of log(work) over log(error)."""
    points = [(math.log(float(row["error"])), math.log(float(row["U_per_simulated_second"]))) for row in rows]
    for (x0, y0), (x1, y1) in zip(points, points[1:]):
        if min(x0, x1) <= math.log(wanted) <= max(x0, x1) and x0 != x1:
            return math.exp(y0 + (y1 - y0) * (math.log(wanted) - x0) / (x1 - x0))
    return math.nan


def work(data):
    fixed, controlled = [], []
    for scene in ("C", "T", "B", "R"):
        rows = chosen(data["W"], scene=scene)
        for setting in dict.fromkeys(row["setting"] for row in rows):
            own = chosen(rows, setting=setting)
            if setting == "controlled":
                continue
            middle = [row for row in own if row["dt"] == "0.001"]
            fixed.append([scene, setting] + [at_step(own, 1e-3 * step) for step in (4, 2, 1, 0.5, 0.25, 0.125, 0.0625,
                                                                                   0.03125)] +
                         [number(middle[0]["U_per_step"]) if middle else "-",
                          number(middle[0]["iterations"]) if middle else "-",
                          number(own[0]["reference_error"], 2)])
        for row in chosen(rows, setting="controlled"):
            same = fixed_work(chosen(rows, setting="default"), float(row["error"]))
            ratio = float(row["U_per_simulated_second"]) / same
            controlled.append([scene, number(row["tolerance"], 1), f"{1e3 * float(row['dt']):.3g}", row["rejected"],
                               number(row["iterations"]), number(row["U_per_simulated_second"]),
                               number(row["error"], 2), "-" if math.isnan(ratio) else number(ratio, 2)])
    return markdown(["scene", "fixed steps", "4 ms", "2", "1", "0.5", "0.25", "0.125", "0.0625", "0.03125",
                     "U a step, 1 ms", "iterations", "error of the reference"], fixed) + "\n\n" + \
        markdown(["scene", "tolerance rad", "mean step ms", "rejected", "iterations", "U a simulated second", "error",
                  "to fixed steps of that error"], controlled)


def settled(data):
    def mean(row, name):
        return f"{number(row[name], 5)} +- {number(row[name + '_error'], 2)}"
    lines = [[f"{1e3 * float(row['dt']):.3g}" +
              (f" (tolerance {number(row['tolerance'])})" if row["tolerance"] else ""),
              row["radius"], row["elements"], number(row["U_per_simulated_second"]), number(row["iterations"]),
              row["rejected"]] + [mean(row, prefix + name) for prefix in ("chatter_", "")
                                  for name in ("force", "torque", "sideways_mm")] for row in data["M"]]
    return markdown(["step ms", "radius", "elements", "U a simulated second", "iterations", "rejected",
                     "0.1 to 1.1 s: force N", "torque N m", "sideways mm", "2 to 3 s: force N", "torque N m",
                     "sideways mm"], lines)


def modes(data):
    lines = [[row["elements"], number(row["us_per_step"]), percent(row["spread"]), number(row["U_per_step"]),
              row["iterations"]] + [f"{number(row[f'error_{i}'], 2)}" for i in range(1, 11, 2)]
             for row in chosen(data["A"], scene="A")]
    every, damped = (chosen(data["A"], scene=scene)[0] for scene in ("A-all", "A-all-damped"))
    growth = exponent(chosen(data["A"], scene="A"), "elements", "us_per_step")[0]
    return markdown(["elements", "us", "spread", "U", "solves"] + [f"error, pair {i}" for i in range(1, 6)], lines) + \
        f"\n\nGrowth: exponent {growth:.3f}. All 600 modes of 100 elements: " + \
        f"{float(every['us_per_step']) / 1e6:.2g} s, largest error of the ten {number(every['error'], 2)}; as a " + \
        f"system with damping {float(damped['us_per_step']) / 1e6:.2g} s, {number(damped['error'], 2)}."


def response(data):
    lines, growths = [], []
    for scene in ("H", "HW", "HJ"):
        rows = chosen(data["H"], scene=scene)
        if not rows:
            continue
        lines += [[scene, row["elements"], row["points"], number(row["us_per_step"]), percent(row["spread"]),
                   number(row["U_per_step"]), number(row["us_two_points"]), number(row["error"], 2)] for row in rows]
        growths.append(f"{scene} {exponent(rows, 'elements', 'us_per_step')[0]:.3f}")
    return markdown(["scene", "elements", "points", "us a point", "spread", "U a point", "us two points", "error"],
                    lines) + f"\n\nGrowth: exponents {', '.join(growths)}."


def buckling(data):
    lines, growths = [], []
    for scene in ("E", "EJ"):
        rows = chosen(data["E"], scene=scene)
        if not rows:
            continue
        lines += [[scene, row["elements"], number(row["us_per_step"]), percent(row["spread"]),
                   number(row["U_per_step"]),
                   number(row["error"], 2)] for row in rows]
        growths.append(f"{scene} {exponent(rows, 'elements', 'us_per_step')[0]:.3f}")
    return markdown(["scene", "elements", "us", "spread", "U", "error"], lines) + \
        f"\n\nGrowth: exponents {', '.join(growths)}."


# ---- Goals -----------------------------------------------------------------------------------------------------------


def first(rows, column, **wanted):
    found = chosen(rows, **wanted)
    return float(found[0][column]) if found else math.nan


def goals_of(data):
    """Name, goal, measured text, met or not (None: not measured)."""
    c, b, r, d = (data.get(scene, []) for scene in ("C", "B", "R", "D"))
    found = []

    def add(name, goal, value, text, met):
        found.append((name, goal, "-", None) if math.isnan(value) else (name, goal, text, met))

    for rows, scene, limit, also in ((c, "C", 0.20, 10.0), (b, "B", 0.40, 0.0)):
        value = first(rows, "U_per_step", group="elements", elements="100")
        taken = first(rows, "us_per_step", group="elements", elements="100")
        add(f"scene {scene}, a step", f"{limit:.2f} U" + (f" or {also:g} us" if also else ""), value,
            f"{value:.3g} U, {taken:.3g} us, error {first(rows, 'error', group='elements', elements='100'):.1e}",
            value <= limit or taken <= also)
    for rows, name, group, limit in ((r, "rig cycle R, 100 pipes", "cycle", 25.0),
                                     (b, "B, 1000 pipes, 1 ms", "long", 5.0)):
        value = first(rows, "rtf", group=group)
        add(name, f"{limit:g} times real time", value,
            f"{value:.3g}, error {first(rows, 'error', group=group):.1e}", value >= limit)
    for rows, scene in ((c, "C"), (b, "B")):
        sizes = chosen(rows, group="growth")
        slope, off = exponent(sizes, "elements", "us_per_step") if len(sizes) > 2 else (math.nan, math.nan)
        each = iteration_exponent(sizes) if len(sizes) > 2 else math.nan
        add(f"growth, 100 to 10000 elements, {scene}", "exponent 1.0 +- 0.03", slope,
            f"{slope:.3f} +- {off:.3f}, an iteration {each:.3f}", abs(slope - 1.0) <= 0.03)
    value = first(c, "us_per_step", group="axial_torsional") / first(c, "us_per_step", group="elements", elements="100")
    add("axial-torsional string", "a fifth of C", value, f"1/{1 / value:.2f}", value <= 0.2)
    for variant in ("plain", "bounded_3"):
        value = first(d, "of_step_99.9", variant=variant)
        largest = first(d, "of_step_largest", variant=variant)
        add(f"step time 99.9 %, scene B, 1 ms, {variant}", "under half the step", value,
            f"{value:.2f} of it, largest {largest:.2f}", value < 0.5)
    bytes_of = [float(row["bytes_per_element"]) for rows in (c, b, r) for row in rows]
    most = max(bytes_of, default=math.nan)
    add("memory an element, the most of C, B, R", "under 3.5 kB", most, f"{most:.0f} bytes", most < 3500)
    return found


def goals(data):
    words = {True: "met", False: "**not met**", None: "not measured"}
    return markdown(["what", "goal", "measured", ""],
                    [[name, goal, text, words[bool(met) if met is not None else None]]
                     for name, goal, text, met in goals_of(data)])


def print_goals(data):
    words = {True: "met", False: "not met", None: "not measured"}
    print("Goals:")
    for name, goal, text, met in goals_of(data):
        print(f"  {name:45s} {goal:22s} {text:37s} {words[met]}")


# ---- Main ------------------------------------------------------------------------------------------------------------

# Name: function, scenes it needs.
TABLES = {"goals": (goals, "CBRD"), "elements": (elements, "CBR"), "others": (others, "CB"),
          "growth": (growth, "CBR"), "pipes": (pipes, "CR"), "joints": (joints, "J"), "clusters": (clusters, "K"),
          "loaded": (loaded, "N"), "loop": (loop, "D"),
          "features": (features, "F"), "work": (work, "W"), "settled": (settled, "M"), "modes": (modes, "A"),
          "response": (response, "H"), "buckling": (buckling, "E")}


def make(data, cards):
    """Name of each table: its text, and whether all its scenes were measured. Those without any are left out."""
    made = {"machine": (machine(data, cards), all(scene in data for scene in "CBRD"))}
    for name, (function, scenes) in TABLES.items():
        needed = [scene in data for scene in scenes]
        if any(needed):
            made[name] = (function(data), all(needed))
    return made


# Columns and rows that a filled page does not have; FOLDER/tables.md has them all. Rows are chosen by a cell.
LEFT_OUT = {"elements": ("spread", "U us"), "features": ("spread", "U us", "model bytes"), "loop": ("in U", "U us"),
            "joints": ("describe us", "compile us", "spread", "U"), "clusters": ("compile us", "spread", "U"),
            "settled": ("rejected",), "loaded": ("spread", "U"), "response": ("spread",), "buckling": ("spread",)}
KEPT = {"joints": ("joints", ("10", "100", "10000")), "clusters": ("bodies", ("3", "10", "21", "100", "321", "1000")),
        "work": ("fixed steps", ("default", "radius_1", "radius_0", "elements_2", "elements_4")),
        "loaded": ("elements a pipe", ("1", "4"))}


def cells(line):
    return [cell.strip() for cell in line.strip("|").split("|")]


def shortened(name, text):
    """A table without the columns of LEFT_OUT and the rows that KEPT does not choose."""
    column, values = KEPT.get(name, (None, ()))
    found, head = [], None
    for line in text.split("\n"):
        row = cells(line) if line.startswith("|") else None
        if row is None:
            found, head = found + [line], None
            continue
        first, head = head is None, head or row
        if first or row[0].startswith("---") or column not in head or row[head.index(column)] in values:
            stay = [cell for title, cell in zip(head, row) if title not in LEFT_OUT.get(name, ())]
            found.append("|" + "---|" * len(stay) if row[0] == "---" else "| " + " | ".join(stay) + " |")
    return "\n".join(found)


def fill(path, made):
    text = path.read_text(encoding="utf-8")
    for name, (content, complete) in made.items():
        if not complete:
            print(f"  {name}: left as it is, not all of its scenes were measured")
            continue
        pattern = re.compile(rf"(<!-- table {name} -->\n).*?(<!-- end -->)", re.DOTALL)
        if not pattern.search(text):
            sys.exit(f"{path}: no place for the table {name}")
        content = shortened(name, content)
        text = pattern.sub(lambda found, content=content: found[1] + content + "\n" + found[2], text)
    path.write_text(text, encoding="utf-8")


def main():
    words = sys.argv[1:]
    target = None
    if words[:1] == ["--fill"] and len(words) > 2:
        target, words = pathlib.Path(words[1]), words[2:]
    if len(words) < 2:
        sys.exit(__doc__)
    folder, scenes = pathlib.Path(words[0]), words[1:]
    data = {scene: measured.read(folder, scene) for scene in scenes}
    data = {scene: rows for scene, rows in data.items() if rows}
    if not data:
        sys.exit("no rows")
    made = make(data, measured.card(folder, next(iter(data))))
    (folder / "tables.md").write_text("".join(f"## {name}\n\n{text}\n\n" for name, (text, _) in made.items()),
                                      encoding="utf-8")
    if target:
        fill(target, made)
    print_goals(data)


main()
