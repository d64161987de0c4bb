"""The reference study: the rows that examples/reference_study prints, as data."""
from __future__ import annotations

import csv
import dataclasses
import html
import pathlib
import re
import subprocess

from case import picture

VERDICTS = ("CONFIRMED IF", "NOT CONFIRMED", "CANNOT BE DECIDED", "NOT COMPUTED", "CONFIRMED")  # the longest first


@dataclasses.dataclass
class Sentence:
    """One sentence of the study."""
    number: int
    where: str
    words: str
    here: str
    verdict: str
    reason: str


def read(text: str) -> tuple[list[Sentence], list[str], str]:
    """Sentences, assumptions and the last line with the counts."""
    lines = text[text.index("The study, one row"):].splitlines()
    table: list[Sentence] = []
    assumptions: list[str] = []
    inside = None
    for line in lines[2:-1]:
        begins = re.match(r" *(\d+)  ([^:]+): (.*)", line)
        if line.startswith("Assumptions"):
            inside = "assumptions"
        elif inside == "assumptions":
            if line.startswith("  - ") or line.startswith("  Not"):
                assumptions.append(line.strip().removeprefix("- "))
            else:
                assumptions[-1] += " " + line.strip()
        elif begins:
            table.append(Sentence(int(begins[1]), begins[2], begins[3], "", "", ""))
        else:
            line, row = line.strip(), table[-1]
            found = next((verdict for verdict in VERDICTS if line.startswith(verdict)), None)
            if found is not None and not row.verdict:
                row.verdict, row.reason = found, line[len(found):].lstrip(": ")
            elif row.verdict:
                row.reason += " " + line
            else:
                row.here += (" " if row.here else "") + line.removeprefix("here: ").removeprefix("here ")
    return table, assumptions, lines[-1]


def run(program: pathlib.Path, folder: pathlib.Path, threads: int = 2, short: bool = False) -> str:
    """Output of the program, whose tables go into the folder."""
    words = [str(program), "--threads", str(threads), "--output", str(folder)] + (["--short"] if short else [])
    return subprocess.run(words, capture_output=True, text=True, check=True).stdout


COLOURS = {"CONFIRMED": "ok", "CONFIRMED IF": "near", "NOT CONFIRMED": "over", "CANNOT BE DECIDED": "open",
           "NOT COMPUTED": "open"}


def table_html(table: list[Sentence]) -> str:
    """The rows as a table."""
    rows = "".join(f'<tr class="{COLOURS[row.verdict]}"><td>{row.number}</td><td>{html.escape(row.where)}</td>'
                   f'<td>{html.escape(row.words)}</td><td>{html.escape(row.here)}</td>'
                   f'<td><span class="verdict">{row.verdict}</span> {html.escape(row.reason)}</td></tr>'
                   for row in table)
    return ('<div class="scroll"><table><tr><th>no.</th><th>where</th><th>the study says</th><th>here</th>'
            f"<th>verdict</th></tr>{rows}</table></div>")


def response_picture(folder: pathlib.Path) -> str:
    """Amplitudes of pipe 100 by cause in X, the axis of the study's figure 11, and in Y and Z."""
    with open(folder / "response.csv", encoding="utf-8", newline="") as text:
        rows = list(csv.reader(text))
    columns = {name: [float(row[k]) for row in rows[1:]] for k, name in enumerate(rows[0])}

    def draw(axes):
        for panel, axis in zip(axes, "XYZ"):
            for cause, color, style in (("drives", "C2", "-"), ("friction", "C0", "-"), ("friction along", "C0", ":"),
                                        ("eccentricity", "C1", "-")):
                values = columns[f"{cause} {axis} [m]"]
                panel.loglog(columns["frequency [Hz]"], [1e3 * value for value in values], style, color=color,
                             linewidth=0.8, label=cause.replace("friction along", "friction, whole coefficient along"))
            panel.axvline(1.58, color="C3", linestyle="--", linewidth=0.8, label="1.58 Hz of the study")
            panel.set(xlabel="frequency [Hz]", title=f"pipe 100, {axis}")
        axes[0].set_ylabel("amplitude [mm]")
        axes[1].legend(fontsize=7, loc="lower left")
    return picture(draw, 3, 9.5, 3.2)
