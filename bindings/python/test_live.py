"""The live page without a browser: the record of a scene makes the same model again, its page is whole and asks for no
network, a log gives the run that it was saved of, and what cannot become a page is refused. bindings/web/test looks at
the page itself."""
import json
import pathlib
import re
import shutil
import subprocess
import unittest

from shared_tests import COMMAND, ENVIRONMENT, FolderTest, needs

needs("numpy")

from drillmbd import enums, live, live_scene, scene  # noqa: E402
from drillmbd.errors import Usage  # noqa: E402
from drillmbd.language import Language  # noqa: E402
from drillmbd.live_strings import strings_of  # noqa: E402
from drillmbd import live_words  # noqa: E402
from drillmbd.model import Model  # noqa: E402

ROOT = pathlib.Path(__file__).resolve().parents[2]
SCENARIOS = sorted((ROOT / "examples" / "live").glob("*.toml"))
SCENES = [*SCENARIOS, ROOT / "examples/scenes/drainage_300m.toml", ROOT / "examples/scenes/steered_rig.toml"]


def revived(model, value):
    """As bindings/web/live/replay.mjs reads a record: ids of this model, numbers that JSON lacks."""
    if isinstance(value, dict):
        if "generation" in value:
            return model.own(live_scene.Id(value["index"], 1 if value["generation"] else 0))
        return {key: revived(model, one) for key, one in value.items()}
    if isinstance(value, list):
        return [revived(model, one) for one in value]
    return float(value) if value in ("NaN", "Infinity", "-Infinity") else value


def rebuilt(record):
    """The model by the record alone."""
    model = Model()
    for name, structs, *count in json.loads(json.dumps(record["calls"], allow_nan=False)):
        cls = live_scene._DEFINITIONS.get(name)
        made = []
        for one in structs:
            one = revived(model, one)
            arrays = {key: one.pop(key) for key in ("survey", "table_time", "table_value", "table_elongation",
                                                    "table_force") if key in one}
            for key in ("survey_count", "table_count") if arrays else ():
                one.pop(key, None)
            if "survey" in arrays:
                one["stations"] = [arrays["survey"][k:k + 3] for k in range(0, len(arrays["survey"]), 3)]
            elif arrays:
                one["table"] = list(zip(*arrays.values()))
            made.append(struct_of(cls, one) if cls else one)
        if name == "set_name":
            model.set_name(made[0]["part"], made[0]["name"])
        else:
            getattr(model, name)(*count, *made)
    return model


def struct_of(cls, fields):
    """A struct with these fields, nested ones as dictionaries."""
    kinds, found = dict(cls._fields_), cls(**{key: fields.pop(key) for key in ("stations", "table") if key in fields})
    for key, value in fields.items():
        setattr(found, key, struct_of(kinds[key], value) if isinstance(value, dict) else value)
    return found


def hash_after(loaded, model, steps=5):
    with model.sim(**loaded.sim) as sim:
        for _ in range(steps):
            sim.step(loaded.run.get("step") or 1e-3)
        return sim.hash()


class Record(unittest.TestCase):
    def test_a_record_makes_the_same_model(self):
        for path in SCENES:
            loaded = scene.load(path)
            record = live_scene.record_of(loaded, path.stem)
            with self.subTest(scene=path.name):
                self.assertEqual(hash_after(loaded, rebuilt(record)), hash_after(loaded, live_scene.model_of(loaded)))

    def test_inputs_of_the_page_change_no_run(self):
        for path in SCENARIOS:
            loaded = scene.load(path)
            outputs = []
            for model in (loaded.model, live_scene.model_of(loaded)):
                with model.sim(**loaded.sim) as sim:
                    sim.static(**loaded.fields_of("static"))
                    for _ in range(100):
                        sim.step(loaded.run["step"])
                    outputs.append([sim.output(quantity, model.own(place)) for _, place, quantity in loaded.outputs])
            with self.subTest(scene=path.name):
                self.assertEqual(*outputs)

    def test_controls_and_traces(self):
        record = live_scene.record_of(scene.load(ROOT / "examples/live/stuck_and_freed.toml"), "x")
        self.assertEqual({one["name"] for one in record["controls"]}, {"feed", "rotation", "stuck", "friction"})
        feed = next(one for one in record["controls"] if one["name"] == "feed")
        self.assertEqual(feed["unit"], "mm/s")
        self.assertAlmostEqual(feed["low"], -12.0)
        self.assertAlmostEqual(feed["high"], 12.0)
        torque, thrust = record["traces"][:2]
        self.assertEqual([one["value"] for one in torque["limits"]], [3.0, -3.0])  # of turning either way
        self.assertEqual([one["value"] for one in thrust["limits"]], [40.0, -60.0])
        self.assertEqual(len(record["traces"]), 4)

    def test_inputs_of_the_scene_stay(self):
        record = live_scene.record_of(scene.load(ROOT / "examples/scenes/steered_rig.toml"), "x")
        names = [one["name"] for one in record["controls"]]
        self.assertEqual(names, ["torque", "feed", "bit load", "friction factor", "mud density"])

    def test_the_scenarios_say_what_they_show(self):
        self.assertEqual(len(SCENARIOS), 3)
        for path in SCENARIOS:
            self.assertGreater(len(live.about(path, scene.load(path))), 80)

    def test_a_string_sticks_and_is_freed(self):
        loaded = scene.load(ROOT / "examples/live/stuck_and_freed.toml")
        with loaded.new_sim() as sim:
            sim.static(**loaded.fields_of("static"))
            part, most = loaded.names["cuttings"], 0.0
            self.assertTrue(sim.stuck(part).stuck)
            while sim.time < 6.0:
                sim.step(loaded.run["step"])
                most = max(most, -sim.output(enums.OUTPUT_DRIVE_FORCE, loaded.names["feed drive"]))
            self.assertFalse(sim.stuck(part).stuck)
        self.assertTrue(25e3 < most < loaded.limits["pull"], most)

    def test_what_stays_in_python_is_refused(self):
        loaded = scene.load(SCENARIOS[0])
        loaded.model = Model()
        loaded.model.add_pipes(2)
        loaded.model.add_drive(component=enums.RX, kind=enums.DRIVE_LOAD,
                               time_function=loaded.model.add_time_function(lambda time: time))
        loaded.model.compile()
        with self.assertRaisesRegex(Usage, "function of Python"):
            live_scene.record_of(loaded, "x")


PIPES = "[[string.pipes]]\nlength = \"1 m\"\ncount = "
#: A string, its continuation behind a sub, one more by a joint of both, and one that lies apart.
STRINGS = f"""
[[string]]
name = "upper"
follows_hole = false
{PIPES}30
outer_diameter = "89 mm"
inner_diameter = "60 mm"
{PIPES}30
[[sub]]
string = "upper"
length = "0.5 m"
body = {{name = "motor", mass = "40 kg"}}
section = {{name = "middle", pipes = {{length = "1 m", count = 20}}}}
[[string]]
name = "last"
follows_hole = false
position = ["80.5 m", 0, 0]
start_free = ["x", "y", "z", "rx", "ry", "rz"]
{PIPES}20
[[string]]
name = "apart"
follows_hole = false
position = [0, "2 m", 0]
{PIPES}5
[[bit]]
string = "last"
[[joint]]
kind = "fixed"
place_a = {{part = "middle", pipe = 19, fraction = 1.0}}
place_b = "last"
[run]
step = "1 ms"
"""


class Strings(unittest.TestCase):
    def test_a_string_continues_the_one_that_it_is_joined_to(self):
        loaded = scene.loads(STRINGS)
        found, with_bit = strings_of(loaded, loaded.names["upper"])
        number = {name: [one["index"] for one in found].index(part.index) for name, part in loaded.names.items()
                  if name in ("upper", "middle", "last", "apart")}
        self.assertEqual({name: found[at]["continues"] for name, at in number.items()},
                         {"upper": None, "middle": number["upper"], "last": number["middle"], "apart": None})
        self.assertEqual(with_bit, number["last"])
        upper = found[number["upper"]]
        self.assertEqual([one["end"] for one in upper["radii"]], [30.0, 60.0])
        self.assertEqual(upper["radii"][0]["radius"], 0.0445)
        self.assertEqual([found[number[name]]["length"] for name in ("upper", "middle", "last", "apart")],
                         [60.0, 20.0, 20.0, 5.0])

    def test_the_first_string_has_the_bit_that_names_none(self):
        loaded = scene.load(SCENARIOS[0])
        found, with_bit = strings_of(loaded, loaded.names[next(iter(loaded.pipes))])
        self.assertEqual((len(found), with_bit, found[0]["continues"]), (1, 0, None))


class Words(unittest.TestCase):
    def test_every_sentence_of_template_and_scripts_is_there_and_used(self):
        folder = ROOT / "bindings/web/live"
        template = set(re.findall(r"\[\[(.+?)\]\]", (folder / "page.html").read_text(encoding="utf-8")))
        self.assertEqual(template, set(live_words.PAGE))
        scripts = {one for path in folder.glob("*.mjs")
                   for one in re.findall(r'\bword\("([^"]*)"', path.read_text(encoding="utf-8"))}
        self.assertEqual(scripts, set(live_words.SCRIPTS))
        self.assertGreater(len(scripts), 20)

    def test_no_text_outside_the_catalogue(self):
        """In the template, letters between tags are of sentences in [[ ]], of parts @name@ that are filled in, or of
        the command."""
        text = re.sub(r"<(style|script).*?</\1>|<code>.*?</code>|<title>.*?</title>", "",
                      (ROOT / "bindings/web/live/page.html").read_text(encoding="utf-8"), flags=re.S)
        left = re.sub(r"\[\[.*?\]\]|@\w+@", "", re.sub(r"<[^>]*>", " ", re.sub(r'aria-label="(.*?)"', r">\1<", text)))
        self.assertEqual(re.findall(r"[A-Za-z]+", left), [])


class Page(FolderTest):
    def setUp(self):
        super().setUp()
        self.package = pathlib.Path(self.folder) / "web"
        shutil.copytree(ROOT / "bindings/web/live", self.package / "live")
        subprocess.run(["python3", ROOT / "bindings/web/generate.py", self.package], check=True)
        shutil.copy(ROOT / "bindings/web/drillmbd.mjs", self.package)
        for name in live.LIBRARIES:
            (self.package / name).write_bytes(b"\0asm\1\0\0\0")  # only the place of the library is used here

    def test_a_page_is_one_file_without_a_network(self):
        for path in SCENARIOS:
            text = live.page(scene.load(path), str(path), self.package)
            self.assertNotRegex(text, r"(src|href)\s*=\s*[\"'](?!#)|https?://|@\w+@")
            self.assertEqual(len(re.findall("</script>", text)), 5)
            record = re.search(r'id="scene">(.*?)</script>', text, re.S)[1]
            self.assertEqual(json.loads(record)["title"], scene.load(path).title)

    def test_a_page_in_chinese(self):
        """Titles and comments of the scene file and names that it gives stay; all else is Chinese."""
        path = SCENARIOS[-1]
        text = live.page(scene.load(path), str(path), self.package, Language("zh"))
        self.assertIn('<html lang="zh-CN">', text)
        record = json.loads(re.search(r'id="scene">(.*?)</script>', text, re.S)[1])
        self.assertEqual(record["words"]["Run"], "运行")
        shown = [one[key] for one in record["traces"] + record["controls"]
                 for key in ("title", "unit")] + [one["text"] for trace in record["traces"] for one in trace["limits"]]
        body = re.sub(r'<p class="about">.*?</p>|<h1>.*?</h1>|<code>.*?</code>', "",
                      re.sub(r"<script.*?</script>|<style.*?</style>", "", text, flags=re.S))
        for one in [*shown, *record["words"].values(),
                    re.sub(r"<[^>]*>", " ", re.sub(r'aria-label="(.*?)"', r">\1<", body[body.index("<body>"):]))]:
            left = set(re.findall(r"[A-Za-z]{2,}", re.sub(r"\{\w+\}", "", one)))
            self.assertLessEqual(left,
                                 set("WebAssembly WebGL libdrillmbd kN mm ms rpm MPa kPa kg deg rad mu bit main string "
                                     "feed rotation GPa".split()), one)
        english = json.loads(re.search(r'id="scene">(.*?)</script>',
                                       live.page(scene.load(path), str(path), self.package), re.S)[1])
        self.assertEqual(english["checksum"], record["checksum"])
        self.assertEqual(english["words"], {})

    @unittest.skipUnless(shutil.which("node"), "not there: node; the scripts were not read")
    def test_the_scripts_are_javascript(self):
        for names in (live.WORKER, live.PAGE):
            path = pathlib.Path(self.folder) / "script.js"
            path.write_text('"use strict";\n' + live.bundle(self.package, names), encoding="utf-8")
            done = subprocess.run(["node", "--check", path], capture_output=True, text=True)
            self.assertEqual(done.returncode, 0, done.stderr)

    def test_the_command_writes_and_replays(self):
        path, page = ROOT / "examples/live/free_drilling.toml", pathlib.Path(self.folder) / "page.html"
        environment = {**ENVIRONMENT, "DRILLMBD_WEB": str(self.package)}

        def call(*words):
            return subprocess.run([*COMMAND, "live", str(path), *words], capture_output=True, text=True,
                                  env=environment)
        done = call("-o", str(page))
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn("MB, opens in a browser", done.stdout)
        self.assertTrue(page.read_text(encoding="utf-8").startswith("<!doctype html>"))
        log = self.log(path)
        target = pathlib.Path(self.folder) / "log.json"
        target.write_text(json.dumps(log), encoding="utf-8")
        done = call("--replay", str(target))
        self.assertEqual(done.returncode, 0, done.stderr + done.stdout)
        self.assertIn(f"hash {log['hash']}, as in the browser", done.stdout)
        for change, text in (({"hash": "0" * 16}, "another version"), ({"checksum": "1"}, "log of another scene"),
                             ({"time": "x"}, "no log")):
            target.write_text(json.dumps({**log, **change}), encoding="utf-8")
            done = call("--replay", str(target))
            self.assertNotEqual(done.returncode, 0)
            self.assertIn(text, done.stdout + done.stderr)

    @staticmethod
    def log(path):
        """As a page writes it, of a hole of 110 mm and two values that were set."""
        loaded = scene.load(path)
        model = live_scene.model_of(loaded, 0.11)
        inputs = []
        with model.sim(**loaded.sim) as sim:
            sim.static(**loaded.fields_of("static"))
            for number in range(100):
                for at, name, value in ((20, "rotation", 8.0), (50, "friction", 1.5)):
                    if number == at:
                        sim.inputs[name] = value
                        inputs.append({"time": sim.time, "input": name, "value": value, "call": len(inputs)})
                sim.step(loaded.run["step"])
            return {"scene": loaded.title, "checksum": live_scene.record_of(loaded, "")["checksum"],
                    "step": loaded.run["step"], "diameter": 0.11,
                    "time": sim.time, "hash": f"{sim.hash():016x}", "inputs": inputs}

    def test_a_package_of_another_version_is_refused(self):
        path = self.package / "interface.mjs"
        text = path.read_text(encoding="utf-8")
        for other in ('"SEGMENT_STEP":99,', ""):  # another value, and a constant that an older version lacks
            changed = re.sub(r'"SEGMENT_STEP":\d+,', other, text)
            self.assertNotEqual(changed, text)
            path.write_text(changed, encoding="utf-8")
            with self.assertRaisesRegex(Usage, "another version of the library.*SEGMENT_STEP.*bindings/web/build"):
                live._same_interface(self.package)
        done = subprocess.run([*COMMAND, "live", str(SCENARIOS[0]), "-o", str(pathlib.Path(self.folder) / "page.html")],
                              capture_output=True, text=True,
                              env={**ENVIRONMENT, "DRILLMBD_WEB": str(self.package)})
        self.assertEqual(done.returncode, 2)
        self.assertIn("another version of the library", done.stderr)

    def test_a_missing_package_is_named(self):
        environment = {**ENVIRONMENT, "DRILLMBD_WEB": "/nowhere"}
        done = subprocess.run([*COMMAND, "live", str(SCENARIOS[0])], capture_output=True, text=True, env=environment)
        self.assertEqual(done.returncode, 2)
        self.assertIn("bindings/web/build", done.stderr)


if __name__ == "__main__":
    unittest.main()
