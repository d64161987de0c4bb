"""The live page without a browser: the record of a scene makes the same model again, its page is whole and asks for no network, a log gives
the run that it was saved of, and what cannot become a page is refused. bindings/web/test looks at the page itself."""
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
            arrays = {key: one.pop(key) for key in ("survey", "table_time", "table_value", "table_elongation", "table_force") if key in one}
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
        self.assertEqual([one["value"] for one in torque["limits"]], [3.0])
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
        loaded.model.add_drive(component=enums.RX, kind=enums.DRIVE_LOAD, time_function=loaded.model.add_time_function(lambda time: time))
        loaded.model.compile()
        with self.assertRaisesRegex(Usage, "function of Python"):
            live_scene.record_of(loaded, "x")


class Page(FolderTest):
    def setUp(self):
        super().setUp()
        self.package = pathlib.Path(self.folder) / "web"
        shutil.copytree(ROOT / "bindings/web/live", self.package / "live")
        subprocess.run(["python3", ROOT / "bindings/web/generate.py", self.package], check=True)
        shutil.copy(ROOT / "bindings/web/drillmbd.mjs", self.package)
        (self.package / "drillmbd.wasm").write_bytes(b"\0asm\1\0\0\0")  # of the library only its place is asked here

    def test_a_page_is_one_file_without_a_network(self):
        for path in SCENARIOS:
            text = live.page(scene.load(path), str(path), self.package)
            self.assertNotRegex(text, r"(src|href)\s*=\s*[\"'](?!#)|https?://|@\w+@")
            self.assertEqual(len(re.findall("</script>", text)), 4)
            record = re.search(r'id="scene">(.*?)</script>', text, re.S)[1]
            self.assertEqual(json.loads(record)["title"], scene.load(path).title)

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

        def ask(*words):
            return subprocess.run([*COMMAND, "live", str(path), *words], capture_output=True, text=True, env=environment)
        done = ask("-o", str(page))
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn("MB, opens in a browser", done.stdout)
        self.assertTrue(page.read_text(encoding="utf-8").startswith("<!doctype html>"))
        log = self.log(path)
        target = pathlib.Path(self.folder) / "log.json"
        target.write_text(json.dumps(log), encoding="utf-8")
        done = ask("--replay", str(target))
        self.assertEqual(done.returncode, 0, done.stderr + done.stdout)
        self.assertIn(f"hash {log['hash']}, as in the browser", done.stdout)
        for change, text in (({"hash": "0" * 16}, "another version"), ({"checksum": "1"}, "log of another scene"), ({"time": "x"}, "no log")):
            target.write_text(json.dumps({**log, **change}), encoding="utf-8")
            done = ask("--replay", str(target))
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
            return {"scene": loaded.title, "checksum": live_scene.record_of(loaded, "")["checksum"], "step": loaded.run["step"], "diameter": 0.11,
                    "time": sim.time, "hash": f"{sim.hash():016x}", "inputs": inputs}

    def test_a_missing_package_is_named(self):
        environment = {**ENVIRONMENT, "DRILLMBD_WEB": "/nowhere"}
        done = subprocess.run([*COMMAND, "live", str(SCENARIOS[0])], capture_output=True, text=True, env=environment)
        self.assertEqual(done.returncode, 2)
        self.assertIn("bindings/web/build", done.stderr)


if __name__ == "__main__":
    unittest.main()
