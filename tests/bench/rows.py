"""Reads what the benchmark has measured: FOLDER/SCENE.csv, rows below the machine's card."""
import csv
import pathlib


def read(folder, scene):
    """Rows of a scene as dictionaries of text; none if it was not measured."""
    path = pathlib.Path(folder) / f"{scene}.csv"
    if not path.exists():
        return []
    with open(path, encoding="utf-8", newline="") as text:
        return list(csv.DictReader(line for line in text if not line.startswith("#")))


def card(folder, scene):
    """The machine's card: name and text of each of its lines."""
    with open(pathlib.Path(folder) / f"{scene}.csv", encoding="utf-8") as text:
        return dict(line[2:].strip().split(": ", 1) for line in text if line.startswith("# "))


def chosen(rows, **wanted):
    """Rows in which the named columns hold the given texts."""
    return [row for row in rows if all(row.get(name) == text for name, text in wanted.items())]
