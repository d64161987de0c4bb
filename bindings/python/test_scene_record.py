"""Scene records of the shipped scenes: read again they give the same run to the bit."""
import contextlib
import ctypes
import io
import os
import pathlib
import re
import tempfile
import unittest

from drillmbd import CompileOptions, Error, command, scene
from drillmbd._library import lib
from drillmbd._structs import SimOptions

SCENES = pathlib.Path(__file__).resolve().parents[2] / "examples" / "scenes"


def hash_after(model, options, steps=5, step=1e-3):
    """Hash of the state of a sim of a model by its handle, after some steps of fixed length."""
    sim, found = ctypes.c_void_p(), ctypes.c_uint64()
    assert lib.dmb_sim_create(model, ctypes.byref(options), ctypes.byref(sim)) >= 0
    try:
        for _ in range(steps):
            assert lib.dmb_sim_step(sim, step, None) >= 0
        assert lib.dmb_sim_hash(sim, ctypes.byref(found)) >= 0
    finally:
        lib.dmb_sim_destroy(ctypes.byref(sim))
    return found.value


def read(found):
    """The model of a record; its handle."""
    model = ctypes.c_void_p()
    status = lib.dmb_model_read(found, len(found), None, ctypes.byref(model))
    assert status == 0, status
    return model


class Records(unittest.TestCase):
    """Written by Python and the command, read by the function of C."""

    def test_array_of_the_firmware_example(self):
        """examples/firmware/rig.h, made by `drillmbd save`, is that of rig.toml beside it: to be made again where it is
        not."""
        folder = SCENES.parent / "firmware"
        text = (folder / "rig.h").read_text(encoding="utf-8").split("{")[1].split("}")[0]
        loaded, model, options = (scene.load(folder / "rig.toml"),
                                  read(bytes(int(one, 16) for one in text.replace(",", " ").split())), CompileOptions())
        self.assertGreaterEqual(lib.dmb_model_compile(model, ctypes.byref(options)), 0)
        sim = SimOptions(bounded_work=1, max_iterations=4)
        self.assertEqual(hash_after(model, sim), hash_after(loaded.model._handle, sim))
        lib.dmb_model_destroy(ctypes.byref(model))

    def test_shipped_scenes(self):
        compared = 0
        for path in sorted(SCENES.glob("*.toml")):
            loaded = scene.load(path)
            try:
                found = loaded.model.record()
            except Error as refused:  # a time function that follows another one's revolutions
                self.assertIn("is a function of the caller", str(refused))
                continue
            model, options = read(found), CompileOptions()
            for name, arguments in loaded.model.calls:
                if name == "compile":
                    options = CompileOptions(**arguments[0]) if isinstance(arguments[0], dict) else arguments[0]
            self.assertGreaterEqual(lib.dmb_model_compile(model, ctypes.byref(options)), 0, path.name)
            sim = SimOptions(**loaded.sim)
            self.assertEqual(hash_after(model, sim), hash_after(loaded.model._handle, sim), path.name)
            lib.dmb_model_destroy(ctypes.byref(model))
            compared += 1
        self.assertGreaterEqual(compared, 3)

    def test_command(self):
        source = str(SCENES / "vertical_1000m.toml")
        wanted = scene.load(source).model.record()
        with tempfile.TemporaryDirectory() as folder, contextlib.redirect_stdout(io.StringIO()):
            written, array = os.path.join(folder, "rig.scene"), os.path.join(folder, "my rig.h")
            self.assertEqual(command.main(["save", source, written]), 0)
            self.assertEqual(pathlib.Path(written).read_bytes(), wanted)
            self.assertEqual(command.main(["save", source, array]), 0)
            text = pathlib.Path(array).read_text(encoding="utf-8")
        self.assertIn(f"static const unsigned char my_rig[{len(wanted)}] = {{", text)
        self.assertEqual(bytes(int(one, 16) for one in re.findall(r"0x([0-9a-f]{2})", text)), wanted)


if __name__ == "__main__":
    unittest.main()
