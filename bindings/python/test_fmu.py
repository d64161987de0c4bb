"""Units for co-simulation exported from scene files, held against the scene's own run (equal numbers), what their
description says against what the scene says, and what is refused."""
import ctypes
import math
import os
import subprocess
import unittest
import zipfile
from ctypes import byref, c_bool, c_double, c_size_t, c_uint32, c_void_p
from xml.etree import ElementTree

from shared_tests import COMMAND, ENVIRONMENT, SHORT_STRING, TURNING, WORN, FolderTest, needs

needs("numpy")

import drillmbd as mbd  # noqa: E402
from drillmbd import EXCITATION_SETTING, Excitation, fmu, scene  # noqa: E402
from test_scene import EVERYTHING, SCENES  # noqa: E402

try:
    fmu.find_binary()
except fmu.CannotExport as missing:
    raise unittest.SkipTest(str(missing)) from missing

SCENE = """title = "short rig <3 & more>"
[hole]
survey = [["0 m", "90 deg", "0 deg"], ["5 m", "88 deg", "1 deg"], ["20 m", "86 deg", "2 deg"]]
diameter = "94 mm"
""" + SHORT_STRING + """load = "push"
[[time_function]]
name = "push"
segment = {table = [["0 s", "0 kN"], ["50 ms", "1 kN"]]}
""" + TURNING + WORN + """[[drive]]
name = "feed"
time_function = "0 m/s"
[[drive]]
name = "head"
kind = "control"
component = "rx"
time_function = "turning"
excitation = "worn"
gain = "500 N m s"
[[spring]]
name = "rope"
place_a = {part = "main", pipe = 2}
offset_b = ["2 m", "1 m", "0 m"]
table = [["-1 m", "-1 N"], ["0 m", "0 N"], ["1 m", "3 N"]]
[[input]]
name = "speed"
part = "head"
initial = "0 rpm"
low = "0 rpm"
high = "300 rpm"
[[input]]
name = "friction"
target = "friction"
low = 0
high = 3
[run]
end = "100 ms"
step = "1 ms"
static = true
[[output]]
name = "torque [N m]"
quantity = "drive-force"
place = "head"
[[output]]
name = "bit speed"
quantity = "bit-speed"
[[output]]
name = "wall force"
quantity = "contacts-normal-force"
"""
EVENT = """[[event]]
name = "fast"
quantity = "bit-speed"
level = "3 rad/s"
"""
MOVED = SCENE.replace('static = true', 'static = false') + """[[load]]
name = "pull"
place = {part = "main", pipe = 7, fraction = 1}
force = ["10 N", "5 N", "0 N"]
[[input]]
name = "advance"
part = "feed"
rate_limit = "0.1 m/s2"
[[input]]
name = "pull factor"
target = "load-factor"
part = "pull"
[[input]]
name = "weight"
target = "bit-load"
part = "bit"
initial = "0.2 kN"
[[output]]
name = "head speed"
quantity = "drive-speed"
place = "head"
""" + "".join(f"""[[output]]
name = "{quantity}"
quantity = "{quantity}"
place = {{part = "main", pipe = 4, fraction = 0.3}}
""" for quantity in ("position-x", "position-z", "velocity-x", "velocity-y", "spin", "rotation", "bit-depth",
                     "rotary-speed",
                      "feed-speed", "stretch", "wind-up", "contacts-deepest", "energy-kinetic", "momentum-x",
                     "centre-y",
                      "world-velocity-x", "body-velocity-ry", "world-acceleration-x"))


class Unit3:
    """The FMI 3.0 functions of an unpacked unit, as an importer calls them."""

    def __init__(self, folder, token, identifier):
        self.library = ctypes.CDLL(str(next((folder / "binaries").glob(f"*/{identifier}.*"))))
        instantiate = self.library.fmi3InstantiateCoSimulation
        instantiate.restype = c_void_p
        self.handle = c_void_p(instantiate(b"rig", token.encode(), str(folder / "resources").encode(), c_bool(False),
                                           c_bool(False),
                                           c_bool(False), c_bool(False), None, c_size_t(0), None, None, None))
        assert self.handle.value

    def call(self, name, *arguments):
        status = getattr(self.library, "fmi3" + name)(self.handle, *arguments)
        assert status == 0, f"{name}: {status}"

    def set(self, reference, value):
        self.call("SetFloat64", byref(c_uint32(reference)), c_size_t(1), byref(c_double(value)), c_size_t(1))

    def get(self, *references):
        values = (c_double * len(references))()
        self.call("GetFloat64", (c_uint32 * len(references))(*references), c_size_t(len(references)), values,
                  c_size_t(len(references)))
        return list(values)

    def derivative(self, unknowns, knowns, seed, refused=None):
        """Shape (unknowns); None where it is refused with that status."""
        values = (c_double * len(unknowns))(*[7.0] * len(unknowns))
        arguments = ((c_uint32 * len(unknowns))(*unknowns), c_size_t(len(unknowns)), (c_uint32 * len(knowns))(*knowns),
                     c_size_t(len(knowns)), (c_double * len(seed))(*seed), c_size_t(len(seed)), values,
                     c_size_t(len(unknowns)))
        if refused is None:
            self.call("GetDirectionalDerivative", *arguments)
            return list(values)
        status = self.library.fmi3GetDirectionalDerivative(self.handle, *arguments)
        assert status == refused, (unknowns, knowns, seed, status)
        assert list(values) == [7.0] * len(unknowns)
        return None

    def begin(self):
        self.call("EnterInitializationMode", c_bool(False), c_double(0.0), c_double(0.0), c_bool(False), c_double(0.0))
        self.call("ExitInitializationMode")

    def step(self, time, length):
        flags, last = [c_bool() for _ in range(3)], c_double()
        self.call("DoStep", c_double(time), c_double(length), c_bool(True), *map(byref, flags), byref(last))

    def snapshot(self, size):
        """The last `size` bytes of the unit's state: the snapshot of its sim."""
        state, length = c_void_p(), c_size_t()
        self.call("GetFMUState", byref(state))
        self.call("SerializedFMUStateSize", state, byref(length))
        block = ctypes.create_string_buffer(length.value)
        self.call("SerializeFMUState", state, block, length)
        self.call("FreeFMUState", byref(state))
        return block.raw[-size:]

    def close(self):
        self.library.fmi3FreeInstance.restype = None
        self.library.fmi3FreeInstance(self.handle)


class Fmu(FolderTest):
    SCENE = SCENE

    def unpacked(self, version=3, text=None):
        """Exports and unpacks: the description's root, the folder."""
        path = self.folder / f"rig{version}.fmu"
        loaded = scene.loads(text or SCENE)
        fmu.export(loaded, path, version)
        folder = self.folder / f"unpacked{version}"
        with zipfile.ZipFile(path) as archive:
            self.assertIsNone(archive.testzip())
            archive.extractall(folder)
        return loaded, ElementTree.parse(folder / "modelDescription.xml").getroot(), folder

    def test_numbers_of_the_scene(self):
        loaded, root, folder = self.unpacked()
        unit = Unit3(folder, root.get("instantiationToken"), "rig3")
        unit.set(100001, 1.25)
        unit.begin()
        with loaded.new_sim() as sim:
            sim.inputs["friction"] = 1.25
            sim.static()
            for step in range(20):
                want = [sim.output(quantity, place) for _, place, quantity in loaded.outputs]
                self.assertEqual(unit.get(200000, 200001, 200002), want)
                unit.set(100000, 5.0 + step)
                sim.inputs["speed"] = 5.0 + step
                unit.step(2e-3 * step, 2e-3)
                sim.step(1e-3)
                sim.step(1e-3)
        self.assertNotEqual(want[0], 0.0)
        self.assertGreater(want[2], 0.0)
        unit.close()

    def same_state(self, loaded):
        """The whole state of the unit after the start and some steps is that of the scene's own run."""
        path = self.folder / "whole.fmu"
        folder = self.folder / f"whole{len(list(self.folder.iterdir()))}"
        fmu.export(loaded, path)
        with zipfile.ZipFile(path) as archive:
            archive.extractall(folder)
        unit = Unit3(folder, ElementTree.parse(folder / "modelDescription.xml").getroot().get("instantiationToken"),
                     "whole")
        unit.begin()
        with loaded.new_sim() as sim:
            if loaded.run.get("static", 0):
                sim.static(**loaded.fields_of("static"))
            for number in range(4):
                want = sim.snapshot()
                self.assertEqual(unit.snapshot(len(want)), want, f"{loaded.title}, {number}")
                unit.step(sim.time, loaded.run["step"])
                if loaded.model.events():
                    sim.advance_to_event(sim.time + loaded.run["step"])
                else:
                    sim.step(loaded.run["step"])
        unit.close()

    def test_inputs_have_their_start_values(self):
        """Whether an importer sets each input to its start value or leaves it: the same bits."""
        loaded, root, folder = self.unpacked(text=MOVED)
        starts = {int(one.get("valueReference")): float(one.get("start")) for one in root.iter()
                  if one.get("causality") == "input"}
        self.assertEqual((len(starts), starts[100004]), (4, 200.0))
        states = []
        for given in ({}, starts):
            unit = Unit3(folder, root.get("instantiationToken"), "rig3")
            unit.begin()
            for number in range(60):  # past the changes of the time functions
                for reference, value in given.items():
                    unit.set(reference, value)
                unit.step(1e-3 * number, 1e-3)
            states.append(unit.get(*range(200000, 200000 + len(loaded.outputs))))
            unit.close()
        self.assertEqual(states[0], states[1])

    def test_every_kind_of_part(self):
        self.same_state(scene.loads(EVERYTHING))

    def test_shipped_scenes(self):
        for path in SCENES:
            self.same_state(scene.load(path))

    def test_inputs_act_after_the_static_state(self):
        """A speed set before the start would be a torque that nothing holds at rest."""
        loaded, root, folder = self.unpacked()
        unit = Unit3(folder, root.get("instantiationToken"), "rig3")
        unit.set(100000, 10.0)
        unit.set(100001, 2.0)
        unit.begin()
        with loaded.new_sim() as sim:
            sim.inputs["friction"] = 2.0
            sim.static()
            sim.inputs["speed"] = 10.0
            self.assertEqual(unit.get(200000, 200001), [sim.output(q, place) for _, place, q in loaded.outputs[:2]])
            self.assertEqual(unit.get(200000), [5000.0])  # gain times speed
            unit.step(0.0, 1e-3)
            sim.step(1e-3)
            self.assertEqual(unit.get(200000, 200001), [sim.output(q, place) for _, place, q in loaded.outputs[:2]])
        unit.close()

    def test_description3(self):
        loaded, root, _ = self.unpacked(3, SCENE + EVENT)
        self.assertEqual((root.get("fmiVersion"), root.get("modelName")), ("3.0", loaded.title))
        self.assertEqual([child.tag for child in root], ["CoSimulation", "UnitDefinitions", "LogCategories",
                                                         "DefaultExperiment",
                                                         "ModelVariables", "ModelStructure"])
        self.assertEqual(root.find("CoSimulation").get("modelIdentifier"), "rig3")
        self.assertEqual(root.find("CoSimulation").get("hasEventMode"), "true")
        found = {one.get("name"): one for one in root.find("ModelVariables")}
        references = [one.get("valueReference") for one in root.find("ModelVariables")]
        self.assertEqual(len(set(references)), len(references))
        self.assertEqual(list(found), ["time", "step", "speed", "friction", "torque", "bit speed", "wall force",
                                       "fast, times"])
        speed, friction = found["speed"], found["friction"]
        self.assertEqual((speed.get("causality"), speed.get("unit"), float(speed.get("start"))),
                         ("input", "rad/s", 0.0))
        self.assertAlmostEqual(float(speed.get("max")), 31.41592653589793, places=12)
        self.assertEqual((friction.get("causality"), friction.get("variability"), friction.get("start")),
                         ("parameter", "tunable", "1.0"))
        self.assertEqual([found[name].get("unit") for name in ("torque", "bit speed", "wall force")],
                         ["N m", "rad/s", "N"])
        self.assertEqual((found["fast, times"].tag, found["fast, times"].get("variability")), ("Int32", "discrete"))
        self.assertEqual(found["step"].get("start"), "0.0")  # events: steps of the library's choice
        outputs = [one.get("valueReference") for one in root.find("ModelVariables") if one.get("causality") == "output"]
        for tag in ("Output", "InitialUnknown"):
            self.assertEqual([one.get("valueReference") for one in root.find("ModelStructure").findall(tag)], outputs)
        self.check_units(root)
        self.assertFalse(any("start" in one.attrib for one in root.find("ModelVariables")
                             if one.get("causality") == "output"))

    def check_units(self, root):
        units = {one.get("name"): one.find("BaseUnit").attrib for one in root.find("UnitDefinitions")}
        self.assertEqual(units["N m"], {"kg": "1", "m": "2", "s": "-2"})
        self.assertEqual(units["rad/s"], {"rad": "1", "s": "-1"})
        used = {one.get("unit") for one in root.find("ModelVariables").iter() if one.get("unit")}
        self.assertEqual(used, set(units))

    def test_dependencies(self):
        """Outputs that the structure calls independent of inputs stay to the bit whatever is set at a communication
        point."""
        loaded, root, folder = self.unpacked(3, MOVED)
        free = {int(one.get("valueReference")) for one in root.find("ModelStructure").findall("Output")
                if one.get("dependencies") == ""}
        outputs = [200000 + number for number in range(len(loaded.outputs))]
        inputs = [100000 + number for number in range(len(loaded.model.inputs()))]
        self.assertEqual(len(free), len(outputs) - 4)  # not of forces and accelerations
        unit = Unit3(folder, root.get("instantiationToken"), "rig3")
        unit.begin()
        changed = set()
        for number in range(12):
            before = dict(zip(outputs, unit.get(*outputs)))
            for reference in inputs:
                unit.set(reference, 0.3 * (number % 5) + 0.01)
                after = dict(zip(outputs, unit.get(*outputs)))
                changed |= {one for one in outputs if after[one] != before[one]}
            unit.step(1e-3 * number, 1e-3)
        unit.close()
        self.assertFalse(changed & free)
        self.assertLessEqual({outputs[0], outputs[-1]}, changed)  # torque of the head, acceleration

    def test_dependencies_by_version(self):
        for version, names in ((3, ("Output", "InitialUnknown")), (2, ("Outputs", "InitialUnknowns"))):
            _, root, _ = self.unpacked(version, SCENE + EVENT)
            structure = root.find("ModelStructure")
            found = [[one.get("dependencies")
                      for one in (structure.findall(tag) if version == 3 else structure.find(tag))]
                     for tag in names]
            # torque, bit speed, wall force, events
            self.assertEqual(found, [[None, "", None, ""], [None, None, None, ""]])

    def test_directional_derivatives(self):
        """At an equilibrium those are D of the state space; of poses and speeds they are 0; along a seed they add
        up."""
        loaded, root, folder = self.unpacked(3, MOVED.replace("static = false", "static = true"))
        self.assertEqual(root.find("CoSimulation").get("providesDirectionalDerivatives"), "true")
        unit = Unit3(folder, root.get("instantiationToken"), "rig3")
        unit.begin()
        names = list(loaded.model.inputs())
        at = {name: 100000 + names.index(name) for name in ("speed", "pull factor", "weight")}
        outputs = [200000 + number for number in range(len(loaded.outputs))]
        found = {name: unit.derivative(outputs, [reference], [1.0]) for name, reference in at.items()}
        free = {int(one.get("valueReference")) for one in root.find("ModelStructure").findall("Output")
                if one.get("dependencies") == ""}
        for values in found.values():
            self.assertEqual({values[number] for number, one in enumerate(outputs) if one in free}, {0.0})
        self.assertAlmostEqual(found["speed"][0], 500.0, delta=1e-8)  # gain: torque over speed
        limited = unit.derivative(outputs, [100000 + names.index("advance")], [1.0])
        self.assertLess(max(map(abs, limited)), 1e-20)  # what has a rate limit does not jump
        with loaded.new_sim() as sim:
            sim.static()
            inputs = [Excitation(kind=EXCITATION_SETTING, place=mbd.station(loaded.model.inputs()[name].input))
                      for name in at]
            requested = [0, len(outputs) - 1]  # torque of the head, acceleration
            D = sim.state_space(inputs, [(loaded.outputs[i][1], loaded.outputs[i][2])
                                         for i in requested]).D
        self.assertGreater(abs(D[1]).min(), 1e-9)
        for column, name in enumerate(at):
            for row, i in enumerate(requested):
                self.assertAlmostEqual(found[name][i], D[row, column], delta=1e-7 * abs(D[row]).max(),
                                       msg=f"{name}, {i}")
        seed = [3.0, -2.0, 0.5]
        together = unit.derivative(outputs, list(at.values()), seed)
        for number, value in enumerate(together):
            want = sum(weight * found[name][number] for name, weight in zip(at, seed))
            self.assertAlmostEqual(value, want, delta=1e-12 * max(1.0, abs(want)))
        unit.close()

    def test_directional_derivatives_change_nothing(self):
        """Between steps of a run, at a bound of the input, in initialization; the run goes on with the same bits."""
        loaded, root, folder = self.unpacked(3, SCENE + EVENT)
        numbers = []
        for asks in (False, True):
            unit = Unit3(folder, root.get("instantiationToken"), "rig3")
            unit.call("EnterInitializationMode", c_bool(False), c_double(0.0), c_double(0.0), c_bool(False),
                      c_double(0.0))
            if asks:
                self.assertAlmostEqual(unit.derivative([200000], [100000], [1.0])[0], 500.0, delta=1e-8)
                self.assertEqual(unit.derivative([200000], [100001], [1.0], 2), None)  # friction: in the static state
            unit.call("ExitInitializationMode")
            seen = []
            for step in range(8):
                unit.set(100000, 31.41592653589793 if step > 5 else 4.0 + step)  # in the end at its upper bound
                if asks:
                    self.assertAlmostEqual(unit.derivative([200000], [100000], [1.0])[0], 500.0, delta=1e-8)
                    pushed = unit.derivative([200001, 200002], [100001, 100000], [1.0, 1.0])
                    self.assertEqual(pushed, [0.0, 0.0])
                seen.append(unit.get(200000, 200001, 200002))
                unit.step(2e-3 * step, 2e-3)
            numbers.append(seen)
            for unknowns, knowns, seed, status in (([100000], [100000], [1.0], 3), ([200000], [200000], [1.0], 3),
                                                   ([300000], [100000], [1.0], 3), ([200000], [1], [1.0], 3),
                                                   ([200000], [100000], [math.inf], 2),
                                                   ([200000], [100000], [math.nan], 2)):
                self.assertEqual(unit.derivative(unknowns, knowns, seed, status), None)
            self.assertEqual(unit.derivative([], [], []), [])
            self.assertEqual(unit.derivative([200000], [], []), [0.0])
            unit.close()
        self.assertEqual(numbers[0], numbers[1])

    def test_description2(self):
        _, root, folder = self.unpacked(2, SCENE + EVENT)
        self.assertEqual(root.get("fmiVersion"), "2.0")
        self.assertTrue(root.get("guid"))
        variables = list(root.find("ModelVariables"))
        self.assertTrue(all(one.tag == "ScalarVariable" and len(one) == 1 for one in variables))
        for tag in ("Outputs", "InitialUnknowns"):
            indices = [int(one.get("index")) for one in root.find("ModelStructure").find(tag)]
            self.assertEqual([variables[i - 1].get("causality") for i in indices], ["output"] * 4)
        self.check_units(root)
        library = ctypes.CDLL(str(next((folder / "binaries").glob("*/rig2.*"))))
        library.fmi2GetVersion.restype = ctypes.c_char_p
        self.assertEqual(library.fmi2GetVersion(), b"2.0")

    def test_units(self):
        for unit, want in (("kg m2/s", {"kg": 1, "m": 2, "s": -1}), ("N s/m2", {"kg": 1, "m": -1, "s": -1}), ("-", {}),
                           ("N m s", {"kg": 1, "m": 2, "s": -1}), ("1/m", {"m": -1}),
                           ("Pa", {"kg": 1, "m": -1, "s": -2})):
            self.assertEqual(fmu.base_exponents(unit), want, unit)
        from drillmbd.outputs import output_numbers, output_unit
        for number in output_numbers():
            if " or " not in output_unit(number) and not output_unit(number).startswith("unit of"):
                fmu.base_exponents(output_unit(number))

    def test_the_same_bytes_each_time(self):
        first, second = self.folder / "rig.fmu", self.folder / "b" / "rig.fmu"
        second.parent.mkdir()
        for path in (first, second):
            fmu.export(scene.loads(SCENE), path)
        self.assertEqual(first.read_bytes(), second.read_bytes())

    def test_refused(self):
        loaded = scene.loads(SCENE)
        bare = scene.loads(SCENE.split("[[output]]")[0])
        for text, given, version in (("no outputs", bare, 3), ("must be 2 or 3", loaded, 4)):
            with self.assertRaisesRegex(fmu.CannotExport, text):
                fmu.export(given, self.folder / "no.fmu", version)
        twice = scene.loads(SCENE.replace('"wall force"', '"bit speed [N]"'))
        with self.assertRaisesRegex(fmu.CannotExport, "of its own"):
            fmu.export(twice, self.folder / "no.fmu")
        for text, name in ((SCENE.replace('initial = "0 rpm"', ""), "speed"),
                           (MOVED.replace('initial = "0.2 kN"', ""), "weight")):
            with self.assertRaisesRegex(fmu.CannotExport, f"input {name} replaces a time function that changes"):
                fmu.export(scene.loads(text), self.folder / "no.fmu")
        with self.assertRaises(OSError):
            fmu.export(loaded, self.folder / "nowhere" / "no.fmu")
        self.assertEqual([one for one in self.folder.iterdir() if "no.fmu" in one.name], [])
        os.environ["DRILLMBD_FMU"] = "/nowhere/unit.so"
        try:
            with self.assertRaisesRegex(fmu.CannotExport, "/nowhere/unit.so"):
                fmu.export(loaded, self.folder / "no.fmu")
        finally:
            del os.environ["DRILLMBD_FMU"]

    def test_functions_of_python_are_refused(self):
        import drillmbd as mbd
        model = mbd.Model()
        string = model.add_pipes(2)
        model.add_drive(time_function=model.add_time_function(lambda time: 0.0))
        model.compile()
        given = scene.Scene(title="", model=model, names={}, pipes={},
                            outputs=[("speed", mbd.station(string), mbd.OUTPUT_SPIN)])
        with self.assertRaisesRegex(fmu.CannotExport,
                                    "segment 0 of time function 0 is a function of the caller, .* give it as a table"):
            fmu.export(given, self.folder / "no.fmu")

    def test_data_behind_pointers_is_refused(self):
        given = scene.loads(SCENE)
        from drillmbd._structs import LOG_FN
        given.sim["log"] = LOG_FN(lambda *_: None)
        with self.assertRaisesRegex(fmu.CannotExport, "sim, log points to data"):
            fmu.export(given, self.folder / "no.fmu")

    def test_names_are_carried(self):
        import drillmbd as mbd
        model = mbd.Model()
        string = model.add_pipes(2)
        model.set_name(string, "rods")
        model.compile()
        given = scene.Scene(title="", model=model, names={}, pipes={},
                            outputs=[("speed", mbd.station(string), mbd.OUTPUT_SPIN)])
        fmu.export(given, self.folder / "named.fmu")
        with zipfile.ZipFile(self.folder / "named.fmu") as archive:
            archive.extractall(self.folder / "named")
        root = ElementTree.parse(self.folder / "named" / "modelDescription.xml").getroot()
        unit = Unit3(self.folder / "named", root.get("instantiationToken"), "named")
        unit.begin()
        self.assertEqual(unit.get(200000), [0.0])
        unit.close()

    def test_command(self):
        target = self.folder / "unit.fmu"
        text = self.call("fmu", str(self.scene), "-o", str(target))
        self.assertIn("2 inputs and parameters, 3 outputs", text)
        self.assertTrue(zipfile.is_zipfile(target))
        self.call("fmu", str(self.scene), "--version", "2", "-q")
        self.assertTrue((self.folder / "rig.fmu").exists())
        self.assertIn("no outputs", self.call("fmu", str(self.write("bare.toml", SCENE.split("[[output]]")[0])),
                                              status=2))
        self.call("fmu", str(self.scene), "-o", str(self.folder / "nowhere" / "x.fmu"), status=3)
        help_text = subprocess.run([*COMMAND, "fmu", "--help"], env=ENVIRONMENT, capture_output=True, text=True,
                                   check=True).stdout
        self.assertIn("drillmbd fmu rig.toml -o rig.fmu", help_text)


if __name__ == "__main__":
    unittest.main()
