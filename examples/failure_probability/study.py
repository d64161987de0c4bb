#!/usr/bin/env python3
"""How often does a hole fail? The reference rig with uncertain hole, pipes and rock, over rotary speed and feed; with contact only, with
friction, with vibration (eccentric pipes, a worn gear), with both; deep against shallow; Sobol' indices; the cost. It makes one page,
failure_probability.html, and failure_probability.json.

    python3 examples/failure_probability/study.py --output out           # short form: minutes on 2 cores
    python3 examples/failure_probability/study.py --output out --long    # all of the 40 s cycle of 100 pipes: overnight
    python3 examples/failure_probability/study.py --output out --compare 250 5 400   # effect of coupling there, 400 samples each

Stopped, it goes on where it was when it is called again. All samples are in out/*.h5."""
import argparse
import base64
import html
import io
import json
import math
import os
import pathlib
import resource
import sys
import time

HERE = pathlib.Path(__file__).resolve().parent
sys.path[:0] = [str(HERE.parents[1] / "bindings" / "python")] if not os.environ.get("PYTHONPATH") else []
if "DRILLMBD_LIBRARY" not in os.environ and (HERE.parents[1] / "build/release/libdrillmbd.so").exists():
    os.environ["DRILLMBD_LIBRARY"] = str(HERE.parents[1] / "build/release/libdrillmbd.so")

import numpy as np  # noqa: E402
from drillmbd.probability import engines  # noqa: E402
from drillmbd.probability.estimates import clopper_pearson, counted, sobol_indices  # noqa: E402
from drillmbd.probability.sampling import Points  # noqa: E402
from drillmbd.probability.sample import FAILED, SceneSample  # noqa: E402
from drillmbd.probability.study import Study, StudyFile, read_rows  # noqa: E402

MODELS = ("contact only", "friction", "vibration", "friction and vibration")
ALL = MODELS[3]
#: The model before and with something more, and its name.
PAIRS = (("contact only", "friction", "friction"), ("contact only", "vibration", "vibration"), ("vibration", ALL, "friction, with vibration"),
         ("friction", ALL, "vibration, with friction"))
CYCLE = {"feed": ((1, 1.0), (-1, 19.0), (-1, 21.0)), "rotation": ((1, 1.0), (-1, 19.0), (-1, 21.0))}
FORMS = {"short": {"end": 4.0, "pipes": 30, "deep": 60, "speeds": (100, 200, 250, 300), "feeds": (5, 20), "samples": 48, "rows": 128, "at": 250},
         "long": {"end": 40.0, "pipes": 100, "deep": 300, "speeds": (100, 200, 250, 300), "feeds": (10,), "samples": 100,
                  "rows": 128, "at": 250},
         "tiny": {"end": 0.2, "pipes": 6, "deep": 8, "speeds": (100, 300), "feeds": (10,), "samples": 4, "rows": 8, "at": 300}}


def changes(form, model, speed, feed, pipes):
    """Of rig.toml."""
    found = {"run.end": f"{form['end']} s", "string[0].pipes[0].count": pipes, "output[1].place.pipe": pipes // 2,
             "response.output[0].place.pipe": pipes // 2, "speeds.output[0].place.pipe": pipes // 2}
    for i, sign in enumerate((1, -1, -1)):
        found[f"time_function[0].segment[{i}].h1"] = f"{sign * feed} mm/s"
        found[f"time_function[1].segment[{i}].h1"] = f"{sign * speed} rpm"
    if form["end"] < 2.0:
        found["failure[5].from"] = f"{0.5 * form['end']} s"
    if "friction" not in model:
        found.update({"hole.mu_static": 1e-9, "hole.mu_dynamic": 1e-9})
    if "vibration" not in model:
        found.update({"string[0].pipes[0].eccentricity": "0 mm", "time_function[2].segment.share": 0})
    return found


class Work:
    """The studies of the page, one after the other."""

    def __init__(self, options):
        self.form, self.folder, self.options = FORMS[options.form], pathlib.Path(options.output), options
        self.folder.mkdir(parents=True, exist_ok=True)
        self.text = (HERE / "rig.toml").read_text(encoding="utf-8")
        self.engine = engines.engine(options.engine, options.workers, options.address)
        self.seconds, self.count, self.lost, self.bytes = 0.0, 0, 0, 0
        self.names = []

    def sample(self, model, speed, feed, pipes=None):
        found = SceneSample(self.text, "rig.toml", str(HERE), changes=changes(self.form, model, speed, feed, pipes or self.form["pipes"]))
        self.names = found.names
        return found

    def study(self, name, sample, settings):
        """A study and its file."""
        file = StudyFile(self.folder / f"{name}.h5", sample, settings)
        return Study(sample, self.engine, file), file

    def case(self, model, speed, feed, pipes=None):
        """Margins of all samples of a case, shape (samples, failures). The same seed everywhere: the same holes and pipes, so that
        differences between cases are not those of the samples."""
        sample = self.sample(model, speed, feed, pipes)
        name = f"{model.replace(' ', '-')}_{speed}rpm_{feed}mms" + (f"_{pipes}pipes" if pipes else "")
        study, file = self.study(name, sample, {"seed": 1})
        points = Points("monte-carlo", 1, sample.dimension, self.form["samples"])
        started = time.monotonic()
        with file:
            results = study.run(range(points.samples), points.z)
        self.add(results, file.path)
        lost = sum(one.status == FAILED for one in results)
        margins = np.array([one.margins for one in results])
        print(f"{name}: {self.told(margins)}" + (f", {lost} lost" if lost else "") + f", {time.monotonic() - started:.0f} s", flush=True)
        return margins

    def add(self, results, path):
        self.seconds += sum(one.seconds for one in results)
        self.count += len(results)
        self.lost += sum(one.status == FAILED for one in results)
        self.bytes = max(self.bytes, read_rows(path)[0].dtype.itemsize)

    def told(self, margins):
        found = counted(margins.min(axis=1))
        return f"{found.probability:.3g} ({found.low:.3g} .. {found.high:.3g})"

    def indices(self):
        """Of the smallest margin over its limit, all coupled. It is cut off at -1, twice the limit: beyond, a few whirling samples would
        have all of the variance."""
        sample = self.sample(ALL, self.form["at"], self.form["feeds"][-1])
        study, file = self.study("indices", sample, {"seed": 1, "rows": self.form["rows"]})
        draw = sample.draw
        groups = dict(zip(sample.inputs, [1] * len(draw.varies.scatters) + draw.sizes[1:]))
        scales = [abs(one.limit) for one in draw.scene.failures]
        with file:
            margins = study.evaluate(0, scales)
            found = sobol_indices(lambda numbers, z: np.maximum(margins(numbers, z), -1.0), groups, self.form["rows"])
        self.add(list(study.results.values()), file.path)
        return found


# ---- Comparison and pictures -----------------------------------------------------------------------------------------------------
def compared(a, b):
    """Whether b fails more often than a, both with the same samples: the difference and, by the exact test of the pairs that differ
    (McNemar), whether chance makes it."""
    fails = [np.nan_to_num(one.min(axis=1), nan=1.0) <= 0.0 for one in (a, b)]
    more, less = int((fails[1] & ~fails[0]).sum()), int((fails[0] & ~fails[1]).sum())
    low, high = clopper_pearson(more, more + less, 0.95) if more + less else (0.0, 1.0)
    word = "raises" if low > 0.5 else "lowers" if high < 0.5 else "not told apart"
    return (more - less) / len(a), more, less, word


def compare(work, speed, feed, samples):
    """Prints the effect of friction and vibration on each other at one speed and feed."""
    if min(speed, feed) < 1 or not 2 <= samples <= 1000000:
        print("study.py: --compare: speed and feed must be >= 1, samples within 2 .. 1000000", file=sys.stderr)
        return 2
    work.form = {**work.form, "samples": samples}
    cases = {model: work.case(model, speed, feed) for model in MODELS}
    for before, after, adding in PAIRS:
        difference, more, less, word = compared(cases[before], cases[after])
        print(f"adding {adding}: {difference:+.3g}, {more} more fail, {less} fewer: {word}")
    return 0


def picture(plot):
    """A figure of matplotlib as an <img>."""
    import matplotlib
    matplotlib.use("Agg")
    from matplotlib import pyplot
    figure = plot(pyplot)
    data = io.BytesIO()
    figure.savefig(data, dpi=90, format="png")
    pyplot.close(figure)
    return f'<img alt="" src="data:image/png;base64,{base64.b64encode(data.getvalue()).decode()}">'


def lines(form, cases):
    """Probability over the speed, a panel for each feed, the models with their intervals side by side."""
    def plot(pyplot):
        figure, axes = pyplot.subplots(1, len(form["feeds"]), figsize=(4.6 * len(form["feeds"]), 3.6), sharey=True, squeeze=False,
                                       constrained_layout=True)
        for axis, feed in zip(axes[0], form["feeds"]):
            for i, (model, style) in enumerate(zip(MODELS, ("o:", "s--", "^-.", "D-"))):
                found = [counted(cases[model, speed, feed].min(axis=1)) for speed in form["speeds"]]
                p = [one.probability for one in found]
                error = [[max(0.0, one.probability - one.low) for one in found], [max(0.0, one.high - one.probability) for one in found]]
                axis.errorbar([speed + 4 * (i - 1.5) for speed in form["speeds"]], p, error, fmt=style, capsize=3, label=model,
                              color=("#999999", "#0072B2", "#D55E00", "#000000")[i])
            axis.set(title=f"feed {feed} mm/s", xlabel="rotary speed [rpm]", ylim=(-0.03, 1.03))
        axes[0][0].set_ylabel("failure probability [-]")
        axes[0][0].legend(loc="upper left", fontsize=8)
        return figure
    return picture(plot)


def table(heads, rows):
    head = "".join(f"<th>{html.escape(str(one))}</th>" for one in heads)
    body = "".join("<tr>" + "".join(f"<td>{html.escape(str(one))}</td>" for one in row) + "</tr>" for row in rows)
    return f"<table><tr>{head}</tr>{body}</table>"


def hours(seconds):
    return f"{seconds / 3600.0:.3g} h"


def main():
    asked = argparse.ArgumentParser(description=__doc__.split("\n")[0], formatter_class=argparse.RawDescriptionHelpFormatter)
    asked.add_argument("--output", "-o", default="failure_probability")
    asked.add_argument("--long", dest="form", action="store_const", const="long", default="short")
    asked.add_argument("--tiny", dest="form", action="store_const", const="tiny", help="only shows that it runs")
    asked.add_argument("--engine", choices=["serial", "threads", "processes", "dask"], default="processes")
    asked.add_argument("--workers", type=int)
    asked.add_argument("--address")
    asked.add_argument("--compare", nargs=3, type=int, metavar=("RPM", "MM_S", "SAMPLES"), help="no page: effect of coupling at a speed and feed")
    options = asked.parse_args()
    started, work = time.monotonic(), Work(options)
    form = work.form
    if options.compare:
        return compare(work, *options.compare)
    cases = {(model, speed, feed): work.case(model, speed, feed)
             for model in MODELS for speed in form["speeds"] for feed in form["feeds"]}
    speed, feed = form["speeds"][-1], form["feeds"][-1]
    deep = work.case(ALL, speed, feed, form["deep"])
    indices = work.indices()
    write(work, cases, deep, indices, time.monotonic() - started)
    return 0


def write(work, cases, deep, indices, elapsed):
    """The page and its numbers."""
    form, names = work.form, work.names
    speed, feed = form["speeds"][-1], form["feeds"][-1]
    rows = [[model, s, f, work.told(cases[model, s, f]), *(f"{counted(cases[model, s, f][:, i]).probability:.3g}" for i in range(len(names)))]
            for model in MODELS for s in form["speeds"] for f in form["feeds"]]
    pairs = []
    for s in form["speeds"]:
        for f in form["feeds"]:
            for before, after, adding in PAIRS:
                difference, more, less, word = compared(cases[before, s, f], cases[after, s, f])
                pairs.append([s, f, adding, f"{difference:+.3g}", more, less, word])
    shallow = cases[ALL, speed, feed]
    depth = [[form["pipes"], work.told(shallow)], [form["deep"], work.told(deep)], ["difference", "{:+.3g}; {} more fail, {} fewer: {}".format(
        *compared(shallow, deep))]]
    order = np.argsort(-indices.total)
    matter = [[indices.names[i], f"{indices.first[i]:.2f} ({indices.first_interval[i, 0]:.2f} .. {indices.first_interval[i, 1]:.2f})",
               f"{indices.total[i]:.2f} ({indices.total_interval[i, 0]:.2f} .. {indices.total_interval[i, 1]:.2f})"] for i in order]
    each = work.seconds / work.count
    scale = [[f"10^{n}", hours(each * 10 ** n), f"{work.bytes * 10 ** n / 1e6:.3g} MB"] for n in range(3, 7)]
    memory = max(resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss, resource.getrusage(resource.RUSAGE_SELF).ru_maxrss) / 1024.0
    cost = (f"{work.count} samples of {form['end']:g} s with {form['pipes']} pipes (and {form['deep']}): {each:.3g} s of a processor each, "
            f"{work.bytes} bytes each in the files, a process takes up to {memory:.0f} MB; this page took {elapsed:.0f} s. "
            f"{work.lost} samples have no margin: in the intervals they count as safe at one end and as failures at the other.")
    page = f"""<!doctype html><html lang="en"><meta charset="utf-8"><title>Failure probability of the reference rig</title>
<style>body{{font:15px/1.45 sans-serif;max-width:76em;margin:2em auto;padding:0 1em}}table{{border-collapse:collapse;margin:1em 0}}
td,th{{border-bottom:1px solid #ccc;padding:.2em .7em;text-align:left;white-space:nowrap}}img{{max-width:100%}}</style>
<h1>Failure probability of the reference rig</h1>
<p>{form['pipes']} pipes, the first {form['end']:g} s of the cycle, {form['samples']} samples a case, intervals of 95 % (Clopper-Pearson). The variables
and the failures with their limits are in <code>examples/failure_probability/rig.toml</code>: the limits are assumptions
of this study, and the probabilities are theirs.</p>
{lines(form, cases)}<h2>All cases</h2>{table(["model", "speed [rpm]", "feed [mm/s]", "any failure", *names], rows)}
<h2>Effect of coupling</h2><p>The same samples with and without: how many fail that did not, how many no longer fail.
"Raises" and "lowers" where chance would not make it (exact test of the pairs that differ, 5 %).</p>
{table(["speed [rpm]", "feed [mm/s]", "adding", "difference", "more fail", "fewer fail", "it"], pairs)}
<h2>Deep against shallow</h2><p>{speed} rpm, {feed} mm/s, friction and vibration.</p>{table(["pipes", "probability"], depth)}
<h2>Most important variables</h2><p>Sobol' indices of the smallest margin over its limit (cut off at twice the limit) at
{form['at']} rpm, {feed} mm/s, friction and vibration; {indices.evaluations} samples, {indices.lost} rows lost.</p>
{table(["variable", "first-order index", "total index"], matter)}
<h2>Cost</h2><p>{html.escape(cost)}</p>{table(["samples", "time of one processor", "file"], scale)}</html>
"""
    (work.folder / "failure_probability.html").write_text(page, encoding="utf-8")
    answer = {"cases": rows, "coupling": pairs, "depth": depth, "indices": matter, "scale": scale, "cost": cost, "failures": names,
              "finite": bool(math.isfinite(each))}
    (work.folder / "failure_probability.json").write_text(json.dumps(answer, indent=1) + "\n", encoding="utf-8")
    print(cost)
    print(work.folder / "failure_probability.html")


if __name__ == "__main__":
    sys.exit(main())
