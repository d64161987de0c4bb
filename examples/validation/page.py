#!/usr/bin/python3
"""The validation page: measured and published figures beside computed ones.

usage: page.py OUTPUT [--study PROGRAM] [--cases NAME,NAME] [--text] [--store]

Writes OUTPUT/validation.html and OUTPUT/validation.txt. PROGRAM is build/.../examples/reference_study; without it the
section of the reference study is left out. --text prints the table; --store keeps the errors that the tests compare
with.
"""
import argparse
import csv
import datetime
import html
import pathlib
import sys
import time

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE))

import beams
import finite_elements
import mechanisms
import paths
import regenerative
import rock
import rolling
import rotors
import stick_slip
import tables
import torsion
import wells
import wing
import work
import study
from case import CASES, MISSED, Case, Row

from drillmbd.report_page import STYLE

GROUPS = (("measured", "Against measurements", "Figures that were measured in wells and tests."),
          ("published", "Against figures that others published or computed",
           "Benchmarks with certain digits, closed forms, and other methods that this page carries itself."))
#: References that were searched for in public pages, documentation and repositories, with the reason why none is
#: compared.
ABSENT = (
    ("Laboratory drill string of the Federal University of Rio de Janeiro (doi:10.1016/j.petrol.2018.07.008)",
     "speed, torque and weight on bit are public (thiagoritto/drillstring), without a licence; stiffness of the shaft "
     "and inertia of the "
     "discs were not found as figures"),
    ("Drill-string set-up of Eindhoven (Mihajlović and others 2004)",
     "abstracts of papers and thesis were found, tables of parameters and limit cycles were not"),
    ("Helical buckling experiments in pipes", "no table of measured loads was found"),
    ("Flexible slider-crank (Simeon 1996; Test Set for IVP Solvers, problem crank)",
     "its digits are of a rod with two lateral shapes, without the stiffness that the axial force adds, and with a "
     "matrix of axial masses that is 15 times that of the beam (crank.f of tpetzoldt/deSolve): a beam that has that "
     "stiffness cannot reproduce them"),
    ("Flexible slider-crank of the library of benchmarks, rotating shaft of Bauchau",
     "parameters or reference digits were not found"),
    ("Coupled axial and torsional vibration of a distributed string (Aarsnes, van de Wouw 2019)",
     "the parameters that belong to the published roots were not found; the axial model is compared by its "
     "characteristic equation"))
CLASSES = {"within": "ok", MISSED: "over", "shown": "open"}
MORE_STYLE = """table.rows td,table.rows th{font-size:13px}td.number{text-align:right;white-space:nowrap;font-variant-numeric:tabular-nums}
dl{display:grid;grid-template-columns:max-content 1fr;gap:2px 12px;margin:.4em 0}dt{font-weight:bold}dd{margin:0}
h3{font-size:1.05em;margin:1.6em 0 .2em}summary{cursor:pointer;margin:.4em 0}svg{max-width:100%;height:auto;display:block;margin:.4em 0}"""  # noqa: E501
assert all((beams, finite_elements, mechanisms, paths, regenerative, rock, rolling, rotors, stick_slip, tables, torsion,
            wells, wing, work))


def number(value: float) -> str:
    """Seven digits at most."""
    return f"{value:.7g}"


def error_of(row: Row) -> str:
    """In percent where it is relative to the reference, else as a number."""
    return f"{100.0 * row.error:+.2g} %" if row.scale is None else f"{row.error:+.2g}"


def bound_of(row: Row) -> str:
    """The largest error that is accepted."""
    return "" if row.bound is None else f"{100.0 * row.bound:.2g} %" if row.scale is None else f"{row.bound:.2g}"


def rows_html(case: Case) -> str:
    """All rows of a case as a table."""
    head = "".join(f"<th>{name}</th>" for name in ("quantity", "mesh, step", "reference", "computed", "error",
                                                   "accepted",
                                                   "fitted", ""))
    body = "".join(
        f'<tr class="{CLASSES[row.verdict]}"><td>{html.escape(row.quantity)} [{row.unit}]</td>'
        f"<td>{html.escape(row.settings)}</td><td class=number>{number(row.reference)}</td>"
        f"<td class=number>{number(row.computed)}</td><td class=number>{error_of(row)}</td>"
        f"<td class=number>{bound_of(row)}</td><td>{html.escape(row.fitted or 'nothing')}</td>"
        f'<td><span class="verdict">{row.verdict}</span></td></tr>' for row in case.rows)
    return f'<div class="scroll"><table class="rows"><tr>{head}</tr>{body}</table></div>'


def case_html(case: Case) -> str:
    """A section of one case."""
    doi = ", ".join(f'<a href="https://doi.org/{one}">doi:{one}</a>' for one in case.doi.split(", ") if one)
    facts = [("source", html.escape(case.source) + (f" ({doi})" if doi else " (no DOI)")),
             ("given", html.escape(case.given)), ("fitted", html.escape(case.fitted))]
    if case.note:
        facts.append(("note", html.escape(case.note)))
    if case.licence:
        facts.append(("data", html.escape(case.licence)))
    facts.append(("processor", f"{case.seconds:.1f} s"))
    listed = "".join(f"<dt>{name}</dt><dd>{text}</dd>" for name, text in facts)
    table = rows_html(case)
    if len(case.rows) > 12:
        table = f"<details><summary>all {len(case.rows)} rows</summary>{table}</details>"
    return (f'<section id="{case.name}"><h3 class="{CLASSES[case.verdict]}">{html.escape(case.title)} '
            f'<span class="verdict">{case.verdict}</span></h3><dl>{listed}</dl>'
            f'{"".join(case.pictures)}{table}</section>')


def finest(case: Case) -> Row:
    """The row that stands for a case in the overview: a missed one with the largest error over its bound, else the last
    row with a bound."""
    bound = [row for row in case.rows if row.bound is not None]
    missed = [row for row in bound if row.verdict == MISSED]
    return max(missed, key=lambda row: abs(row.error / row.bound)) if missed else (bound or case.rows)[-1]


def overview(cases: list[Case]) -> str:
    """One line a case."""
    lines = ""
    for case in sorted(cases, key=lambda one: one.kind):
        row, count = finest(case), sum(row.verdict == MISSED for row in case.rows)
        checked = sum(row.bound is not None for row in case.rows)
        lines += (f'<tr class="{CLASSES[case.verdict]}"><td><a href="#{case.name}">{html.escape(case.title)}</a></td>'
                  f"<td>{case.kind}</td><td>{html.escape(case.fitted.split(';')[0])}</td>"
                  f"<td>{html.escape(row.quantity)}{', ' + html.escape(row.settings) if row.settings else ''}</td>"
                  f"<td class=number>{error_of(row)}</td><td class=number>{bound_of(row)}</td>"
                  f'<td><span class="verdict">{case.verdict}</span> {checked - count} of {checked}</td></tr>')
    return ('<div class="scroll"><table class="rows"><tr><th>case</th><th>reference</th><th>fitted</th><th>for example '
            '(the '
            "worst missed row, else the finest)</th><th>error</th><th>accepted</th><th>rows "
            f"within</th></tr>{lines}</table></div>")


def compute(names: list[str]) -> list[Case]:
    """The cases by name, with their seconds of processor."""
    made = []
    for name in names:
        before = time.process_time()
        found = CASES[name][0](True)
        found.seconds = time.process_time() - before
        print(f"{found.verdict:7} {name:12} {found.seconds:6.1f} s  {found.title}", flush=True)
        made.append(found)
    return made


def text_table(cases: list[Case], told: str) -> str:
    """The page as text."""
    lines = []
    for case in cases:
        lines += [f"{case.title}: {case.verdict}", f"    {case.source}{' doi:' + case.doi if case.doi else ''}",
                  f"    given: {case.given}", f"    fitted: {case.fitted}"]
        lines += [f"    {row.verdict:7} {row.quantity + ' [' + row.unit + ']':62} {row.settings:28} "
                  f"{number(row.reference):>14} "
                  f"{number(row.computed):>14} {error_of(row):>10} {bound_of(row):>8}  {row.fitted}".rstrip()
                  for row in case.rows]
        lines += [f"    note: {case.note}"] if case.note else []
        lines.append("")
    return "\n".join(lines) + told


def store(cases: list[Case]) -> None:
    """Errors of the cases that run in the tests."""
    with open(HERE / "stored.csv", "w", encoding="utf-8", newline="") as text:
        writer = csv.writer(text, lineterminator="\n")
        writer.writerow(("case", "quantity", "settings", "error", "verdict"))
        writer.writerows((case.name, row.quantity, row.settings, f"{row.error:.6e}", row.verdict)
                         for case in cases if CASES[case.name][1] for row in case.rows)


def absent() -> str:
    """The references that are not compared, with reasons."""
    listed = "".join(f"<li>{html.escape(name)}: {html.escape(reason)}.</li>" for name, reason in ABSENT)
    return f"<h2>Searched for and not compared</h2><ul>{listed}</ul>"


def page(cases: list[Case], study_part: str) -> str:
    """The whole page."""
    parts = []
    for kind, title, words in GROUPS:
        chosen = [case for case in cases if case.kind == kind]
        if chosen:
            parts.append(f"<h2>{title}</h2><p>{words}</p>" + "".join(map(case_html, chosen)))
    missed = sum(case.verdict == MISSED for case in cases)
    return (f'<!doctype html><html lang="en"><meta charset="utf-8"><meta name="viewport" content="width=device-width">'
            f"<title>Validation of libdrillmbd</title><style>{STYLE}{MORE_STYLE}</style><h1>Validation of "
            "libdrillmbd</h1>"
            f'<p class="made">made {datetime.date.today().isoformat()} by examples/validation/run</p>'
            "<p>Measured and published figures beside computed ones. The error is computed over reference less one, "
            "or the "
            f"difference where it has no percent sign. <b>{len(cases) - missed} of {len(cases)} cases are within what "
            "is "
            "accepted in all rows</b>; a case that misses is shown with what was looked at. What was fitted to the "
            "reference "
            "is named in the row; nothing else was. The two cases of the wing are blind predictions: scenes and rules "
            "were committed (343a141e, "
            "d64773ae) before the measured figures were read. Of the Volve well the scene and the rule of fitting "
            "were committed (2bb9b25d) "
            "before the figures below 2200 m were read, but that its friction factor falls from 0.257 to 0.220 with "
            "depth was "
            f"known.</p>{overview(cases)}{''.join(parts)}{absent()}{study_part}</html>")


def study_section(program: pathlib.Path, folder: pathlib.Path) -> tuple[str, str]:
    """The reference study as a section and as text."""
    printed = study.run(program, folder)
    table, assumptions, counts = study.read(printed)
    listed = "".join(f"<li>{html.escape(one)}</li>" for one in assumptions)
    part = ('<h2 id="study">The reference study, sentence by sentence</h2><p>A numerical study of a gas-drainage rig, '
            'J. '
            'Computational Methods in Sciences and Engineering, <a '
            'href="https://doi.org/10.3233/JCM-194119">doi:10.3233/'
            "JCM-194119</a>; its equations and the means of two figures were lost in the text at hand. One row for "
            "each sentence "
            f"that can be tested, in its own quantity and axis. <b>{html.escape(counts)}.</b></p>"
            f"{study.response_picture(folder)}{study.table_html(table)}"
            f"<h3>Assumptions of this project, which the study does not give</h3><ul>{listed}</ul>")
    return part, printed[printed.index("The study, one row"):]


def main() -> None:
    """Makes the page."""
    words = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    words.add_argument("output", type=pathlib.Path)
    words.add_argument("--study", type=pathlib.Path)
    words.add_argument("--cases")
    words.add_argument("--text", action="store_true")
    words.add_argument("--store", action="store_true", help="writes stored.csv, which the tests compare with")
    given = words.parse_args()
    given.output.mkdir(parents=True, exist_ok=True)
    names = given.cases.split(",") if given.cases else list(CASES)
    unknown = [name for name in names if name not in CASES]
    if unknown:
        words.error(f"--cases: {', '.join(unknown)} is no case; there are {', '.join(CASES)}")
    part, told = study_section(given.study, given.output) if given.study else ("", "")
    cases = compute(names)
    text = text_table(cases, told)
    (given.output / "validation.html").write_text(page(cases, part), encoding="utf-8")
    (given.output / "validation.txt").write_text(text, encoding="utf-8")
    if given.store:
        store(cases)
    if given.text:
        print(text)
    print(f"The page is {given.output / 'validation.html'}, the table validation.txt beside it")


if __name__ == "__main__":
    main()
