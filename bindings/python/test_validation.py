"""Tests of the validation page: its cheap cases give the errors that are stored, each within what is accepted or shown
as missed; the page names source, fit and verdict of each; rows of the reference study are read from what its program
prints."""
import csv
import pathlib
import sys
import tempfile
import unittest

from shared_tests import needs

needs("matplotlib", "numpy", "scipy")

ROOT = pathlib.Path(__file__).resolve().parents[2]
VALIDATION = ROOT / "examples" / "validation"
sys.path.insert(0, str(VALIDATION))
import page
import stick_slip
import study
from case import CASES, MET, MISSED, Case, Row

MEASURED_AGAIN = 0.05  # of a stored error, and a hundredth of what is accepted


def stored():
    """Rows of each case as they were stored: quantity, settings, error, verdict."""
    found = {}
    with open(VALIDATION / "stored.csv", encoding="utf-8", newline="") as text:
        for row in csv.DictReader(text):
            found.setdefault(row["case"], []).append((row["quantity"], row["settings"], float(row["error"]),
                                                      row["verdict"]))
    return found


class CaseTest(unittest.TestCase):
    def test_cheap_cases_give_the_stored_errors(self):
        want = stored()
        self.assertEqual(set(want), {name for name, (_, quick) in CASES.items() if quick})
        for name, rows in want.items():
            case = CASES[name][0](False)
            self.assertEqual([(row.quantity, row.settings, row.verdict) for row in case.rows],
                             [(quantity, settings, verdict) for quantity, settings, _, verdict in rows], name)
            for row, (quantity, settings, error, _) in zip(case.rows, rows):
                near = MEASURED_AGAIN * abs(error) + 0.01 * (row.bound or abs(error)) + 1e-12
                self.assertLess(abs(row.error - error), near, f"{name}: {quantity}, {settings}")

    def test_two_solutions_of_stick_slip_wind_up_alike(self):
        """Before the string breaks off; the case itself takes 11 s and runs for the page only."""
        ours, theirs = stick_slip.simulate(end=6.0, cells=30), stick_slip.upwind(end=6.0, cells=120)
        for time in (3.0, 5.9):
            torque, want = (float(curve[1][abs(curve[0] - time) < 0.55].mean()) for curve in (ours, theirs))
            self.assertGreater(want, 4e3)
            self.assertLess(abs(torque / want - 1.0), 0.1)

    def test_verdicts(self):
        row = Row("length", "m", 2.0, 2.1, "", 0.04)
        self.assertAlmostEqual(row.error, 0.05)
        self.assertEqual(row.verdict, MISSED)
        row.bound = 0.06
        self.assertEqual(row.verdict, MET)
        row.scale, row.bound = 10.0, 0.0101
        self.assertAlmostEqual(row.error, 0.01)
        self.assertEqual(row.verdict, MET)


class PageTest(unittest.TestCase):
    def test_page_names_source_fit_and_verdict(self):
        rows = [Row("load & pull", "kN", 1.0, 1.2, "coarse", 0.1, fitted="friction 0.3")]
        case = Case("one", "A <well>", "measured", "Somebody 1999", "10.1000/1", "survey", "friction factor", rows,
                    "looked at")
        text = page.page([case], "")
        for part in ("A &lt;well&gt;", "load &amp; pull", "https://doi.org/10.1000/1", "friction 0.3", "looked at",
                     "+20 %",
                     '<tr class="over">', "0 of 1 cases"):
            self.assertIn(part, text)
        self.assertNotIn("src=\"http", text)
        self.assertIn("MISSED", page.text_table([case], ""))

    def test_one_command(self):
        with tempfile.TemporaryDirectory() as folder:
            arguments, sys.argv = sys.argv, ["page.py", folder, "--cases", "nozzles,elastica"]
            try:
                page.main()
            finally:
                sys.argv = arguments
            made = pathlib.Path(folder, "validation.html").read_text(encoding="utf-8")
            self.assertIn("2 of 2 cases", made)
            self.assertIn("<svg", made)


class StudyTest(unittest.TestCase):
    def test_rows_are_those_of_the_stored_result(self):
        text = (ROOT / "examples" / "reference_study" / "expected.txt").read_text(encoding="utf-8")
        table, assumptions, counts = study.read(text.rstrip("\n"))
        self.assertEqual([row.number for row in table], list(range(1, len(table) + 1)))
        names = {"CONFIRMED": "confirmed", "CONFIRMED IF": "confirmed if", "NOT CONFIRMED": "not confirmed",
                 "CANNOT BE DECIDED": "cannot be decided"}
        said = ", ".join(f"{sum(row.verdict == verdict for row in table)} {name}" for verdict, name in names.items())
        self.assertEqual(counts, said)
        self.assertGreater(len(assumptions), 5)
        for row in table:
            self.assertTrue(row.where and row.words and row.here and row.reason, row)

    def test_readme_states_the_counts(self):
        text = (ROOT / "examples" / "reference_study" / "expected.txt").read_text(encoding="utf-8")
        table, _, _ = study.read(text.rstrip("\n"))
        count = {verdict: sum(row.verdict == verdict for row in table) for verdict in study.VERDICTS}
        readme = " ".join((ROOT / "README.md").read_text(encoding="utf-8").split())
        self.assertIn(f"of {len(table)} of its sentences {count['CONFIRMED']} are confirmed, {count['CONFIRMED IF']} "
                      "under a stated "
                      f"condition, {count['NOT CONFIRMED']} are not, and {count['CANNOT BE DECIDED']} cannot be "
                      "decided", readme)


if __name__ == "__main__":
    unittest.main()
