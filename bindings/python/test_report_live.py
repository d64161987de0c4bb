"""The report that runs its scene: the packed page is that of drillmbd live; where it cannot be made the report still
comes, with the reason."""
import base64
import gzip
import json
import pathlib
import re
import shutil
import subprocess
import unittest
import unittest.mock

from shared_tests import COMMAND, ENVIRONMENT, SHORT_RIG, FolderTest, needs

needs("numpy")

from drillmbd import enums, live, report_live, scene  # noqa: E402
from drillmbd.language import Language  # noqa: E402
from drillmbd.model import Model  # noqa: E402
from drillmbd.verdict import NOT_COMPUTED  # noqa: E402

ROOT = pathlib.Path(__file__).resolve().parents[2]
SCENE = 'title = "short hole"\n' + SHORT_RIG + """[run]
end = "4 ms"
step = "1 ms"
"""


class ReportLive(FolderTest):
    def setUp(self):
        super().setUp()
        needs("plotly")
        self.package = pathlib.Path(self.folder) / "web"
        shutil.copytree(ROOT / "bindings/web/live", self.package / "live")
        subprocess.run(["python3", ROOT / "bindings/web/generate.py", self.package], check=True)
        shutil.copy(ROOT / "bindings/web/drillmbd.mjs", self.package)
        for name in live.LIBRARIES:
            (self.package / name).write_bytes(b"\0asm\1\0\0\0")  # bindings/web/test runs the page
        self.scene = self.write("rig.toml", SCENE)

    def report(self, *more, web=None):
        target = pathlib.Path(self.folder) / "out"
        done = subprocess.run([*COMMAND, "report", str(self.scene), "-o", str(target), *more], capture_output=True,
                              text=True,
                              env={**ENVIRONMENT, "DRILLMBD_WEB": str(web or self.package)})
        self.assertEqual(done.returncode, 0, done.stderr)
        page, summary = ((target / name).read_text(encoding="utf-8") for name in ("report.html", "summary.json"))
        return done.stdout, page, json.loads(summary)

    def test_the_page_of_the_scene_is_in_the_report(self):
        _, page, summary = self.report("--live")
        packed = re.search(r'id="livepage">(.*?)</script>', page)[1]
        self.assertEqual(gzip.decompress(base64.b64decode(packed)).decode(),
                         live.page(scene.load(self.scene), str(self.scene), self.package, packed=True))
        self.assertIn('<button id="start">Start</button>', page)
        self.assertNotIn("not included", page)
        self.assertNotIn("Scene to run in this page", [one["title"] for one in summary["verdicts"]])

    def test_without_the_option_there_is_none(self):
        _, page, _ = self.report()
        self.assertNotIn('id="livepage"', page)
        self.assertNotIn('id="start"', page)

    def test_in_chinese(self):
        _, page, _ = self.report("--live", "--language", "zh")
        self.assertIn("运行场景", page)
        inside = gzip.decompress(base64.b64decode(re.search(r'id="livepage">(.*?)</script>', page)[1])).decode()
        self.assertIn('<html lang="zh-CN">', inside)
        self.assertIn("保存状态", inside)

    def test_without_the_package_the_report_comes_with_the_reason(self):
        out, page, summary = self.report("--live", web="/nowhere")
        line = next(one for one in out.splitlines() if one.startswith("Scene to run in this page"))
        self.assertIn("NOT COMPUTED", line)
        self.assertIn("bindings/web/build", line)
        self.assertIn("Results against limits", page)
        self.assertNotIn('id="livepage"', page)
        tile = next(one for one in summary["verdicts"] if one["title"] == "Scene to run in this page")
        self.assertEqual(tile["value"], "not included")

    def test_a_scene_that_live_refuses_becomes_a_tile(self):
        loaded = scene.load(self.scene)
        with unittest.mock.patch.object(live, "find_package", return_value=self.package):
            text, tile = report_live.packed_page(loaded, str(self.scene), Language())
            self.assertTrue(text)
            self.assertIsNone(tile)
            with unittest.mock.patch.object(live, "LARGEST", 1000):
                text, tile = report_live.packed_page(loaded, str(self.scene), Language())
            self.assertEqual((text, tile.verdict), ("", NOT_COMPUTED))
            self.assertIn("must be <= 0.001 MB", tile.text)
            loaded.model = Model()
            loaded.model.add_pipes(2)
            loaded.model.add_drive(component=enums.RX, kind=enums.DRIVE_LOAD,
                                   time_function=loaded.model.add_time_function(lambda time: time))
            loaded.model.compile()
            text, tile = report_live.packed_page(loaded, str(self.scene), Language())
        self.assertEqual((text, tile.verdict), ("", NOT_COMPUTED))
        self.assertIn("function of Python", tile.text)
        self.assertNotIn("live page refused", tile.text)


if __name__ == "__main__":
    unittest.main()
