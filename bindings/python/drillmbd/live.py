"""The live page: one HTML file that holds a scene, the library as WebAssembly and the view, and opens without a
network.

    from drillmbd import live, scene
    live.write(scene.load("hole.toml"), "hole.toml", "hole.html")

The package of JavaScript (bindings/web/build) is found in the folder that the environment variable DRILLMBD_WEB names,
beside the library, and in share/drillmbd/web of the usual prefixes."""
from __future__ import annotations

import base64
import gzip
import html
import json
import os
import pathlib
import re
import sys
from typing import Any

from . import __version__, _library, enums
from ._structs import InputRecord
from .errors import Usage
from .language import ENGLISH, Language, phrase
from .live_scene import model_of, record_of
from .live_words import filled, of_scripts
from .scene import Scene, words

#: scripts, each after those that it uses
WORKER = ("interface.mjs", "drillmbd.mjs", "live/words.mjs", "live/replay.mjs", "live/worker.mjs")
PAGE = ("live/words.mjs", "live/traces.mjs", "live/view.mjs", "live/page.mjs")
#: for all browsers, and for those with instructions for two numbers at once
LIBRARIES = ("drillmbd.wasm", "drillmbd_simd.wasm")
LARGEST = 5_000_000  #: [byte]


# ---- Parts -----------------------------------------------------------------------------------------------------------
def find_package() -> pathlib.Path:
    """The folder of the built package."""
    own = os.environ.get("DRILLMBD_WEB")
    library = pathlib.Path(_library.find()).resolve().parent
    places = [pathlib.Path(own)] if own else [
        library / "web", library.parent / "web", _library.HERE / "web",
        *(pathlib.Path(prefix) / "share/drillmbd/web" for prefix in (str(library.parent), str(library.parents[1]),
                                                                     sys.prefix, "/usr/local", "/usr"))]
    for place in places:
        if all((place / name).is_file() for name in (*LIBRARIES, *WORKER, *PAGE)):
            _same_interface(place)
            return place
    where = f"DRILLMBD_WEB = {own} does not hold" if own else \
        "neither the folder of the library nor share/drillmbd/web holds"
    raise Usage(f"live page refused: {where} the library as WebAssembly; install it by a CMake build with "
                "-DDMB_BUILD_WEB=ON, or run "
                "bindings/web/build FOLDER in the source tree and set the environment variable DRILLMBD_WEB to FOLDER")


def _same_interface(folder: pathlib.Path) -> None:
    """Refuses a package that was built of other headers: numbers of a scene have another meaning there."""
    found = re.search(r"^export const CONSTANTS = (\{.*\});$", (folder / "interface.mjs").read_text(encoding="utf-8"),
                      re.M)
    known = json.loads(found[1]) if found else {}
    ours = {name: value for name, value in vars(enums).items() if name.isupper() and isinstance(value, (int, float))}
    other = sorted(name for name in ours.keys() | known.keys() if known.get(name) != ours.get(name))
    if other:
        raise Usage(f"live page refused: {folder} was built of another version of the library ({len(other)} constants "
                    f"differ, as {other[0]}); run bindings/web/build "
                    "of this version again")


def bundle(folder: pathlib.Path, names: tuple[str, ...]) -> str:
    """One script of several modules: they share a scope, so imports are left out but for those that rename, and exports
    are plain."""
    found = []
    for name in names:
        text = (folder / name).read_text(encoding="utf-8")
        renamed = [f"const {new} = {old};" for line in re.findall(r"^import \{([^}]*)\} from .*;$", text, re.M)
                   for old, new in re.findall(r"(\w+) as (\w+)", line)]
        text = re.sub(r"^import .*;\n", "", text, flags=re.M)
        text = re.sub(r"^export (?=(async )?(function|class|const) )", "", text, flags=re.M)
        found.append("\n".join([*renamed, text]))
    script = "\n".join(found)
    if re.search(r"^\s*(import|export) |</script|<!--", script, re.M):
        raise ValueError(f"{', '.join(names)}: has an import, an export or an end of a script that the page cannot "
                         "hold")
    return script


def about(file: str, scene: Scene) -> str:
    """The comment at the head of the scene file, which explains the scene."""
    lines = []
    for line in pathlib.Path(file).read_text(encoding="utf-8-sig").splitlines() if os.path.isfile(file) else []:
        if not line.startswith("#"):
            break
        lines.append(line.lstrip("# "))
    return " ".join(lines) if lines and not lines[-1].startswith("drillmbd ") else scene.title


def page(scene: Scene, file: str, folder: pathlib.Path | None = None, to: Language = ENGLISH,
         packed: bool = False) -> str:
    """The HTML of a scene that was read from a file. packed: smaller, for browsers that can unpack."""
    folder = find_package() if folder is None else folder
    record = {**to.all(record_of(scene, os.path.splitext(os.path.basename(file))[0])), "words": of_scripts(to)}
    with scene.new_sim() as sim:
        understood = words.describe(scene, sim.momentum().mass)
    text = json.dumps(record, separators=(",", ":"), ensure_ascii=False, allow_nan=False).replace("<", "\\u003c")
    details = "".join(f"<li>{html.escape(to(one))}</li>" for one in understood)
    local = phrase("Computed in this browser by libdrillmbd {version}; nothing is sent to a network.",
                   version=__version__)
    parts = {"title": html.escape(scene.title or os.path.basename(file)), "about": html.escape(about(file, scene)),
             "style": (folder / "live/page.css").read_text(encoding="utf-8"),
             "details": f"<ul>{details}</ul><p>{html.escape(to(local))}</p>", "tag": to.tag,
             "wasm": _text_of(folder / "drillmbd.wasm", packed), "packed": "1" if packed else "",
             "simd": _text_of(folder / "drillmbd_simd.wasm", True),
             "scene": text,
             "worker": bundle(folder, WORKER), "page": bundle(folder, PAGE)}
    template = filled((folder / "live/page.html").read_text(encoding="utf-8"), to)
    return re.sub(r"@(\w+)@", lambda match: parts[match.group(1)], template)


def _text_of(path: pathlib.Path, packed: bool) -> str:
    """The bytes of a file in base64, packed by gzip on request."""
    content = path.read_bytes()
    return base64.b64encode(gzip.compress(content, 9, mtime=0) if packed else content).decode()


def small_page(scene: Scene, file: str, to: Language = ENGLISH, packed: bool = False) -> bytes:
    """The page, which is refused above LARGEST."""
    text = page(scene, file, to=to, packed=packed).encode()
    if len(text) > LARGEST:
        raise Usage(f"live page refused: it would have {len(text) / 1e6:.1f} MB, must be <= {LARGEST / 1e6:g} MB; "
                    "describe a shorter survey or shorter tables")
    return text


def write(scene: Scene, file: str, target: Any, to: Language = ENGLISH) -> int:
    """Writes the page; returns its size [byte]."""
    text = small_page(scene, file, to)
    pathlib.Path(target).write_bytes(text)
    return len(text)


# ---- A saved log -----------------------------------------------------------------------------------------------------
def replay(scene: Scene, path: Any) -> tuple[str, str, float]:
    """Computes the run of a saved log with the native library: hash of the state at its end, the hash that the log has,
    time [s]."""
    log = _read(path)
    checksum = record_of(scene, "")["checksum"]
    if log["checksum"] != checksum:
        raise Usage(f"{path}: is the log of another scene ({log['scene']!r}, checksum {log['checksum']}), must be of "
                    f"this one ({checksum}); give the file "
                    "that the page was made of, as it was then")
    model = model_of(scene, log["diameter"])
    numbers = {name: number for number, name in enumerate(model.inputs())}
    records = [InputRecord(time=one["time"], value=one["value"], input=numbers[one["input"]], call=one["call"])
               for one in log["inputs"]]
    with model.sim(**scene.sim) as sim:
        if scene.run.get("static", 0):
            sim.static(**scene.fields_of("static"))
        _run(sim, records, log["time"], log["step"], scene.run.get("end", 0.0))
        return f"{sim.hash():016x}", log["hash"], sim.time


def _run(sim: Any, records: list[Any], end: float, step: float, length: float) -> None:
    """The steps of the page: an input that was set at a time is set before the step that begins then."""
    at, hundredth = 0, 0
    while True:
        if at < len(records):
            at = sim.inputs.replay(records, at)
        if sim.time >= end - 1e-9:
            return
        hundredth += 1
        if step:
            sim.step(step)
        else:
            sim.advance(hundredth * (length or 10.0) / 100.0)


def _read(path: Any) -> dict[str, Any]:
    try:
        log = json.loads(pathlib.Path(path).read_text(encoding="utf-8"))
        for key, kind in (("checksum", str), ("hash", str), ("time", float), ("step", float), ("inputs", list)):
            if not isinstance(log[key], (kind, int) if kind is float else kind):
                raise TypeError(key)
        for one in log["inputs"]:
            one["time"], one["value"], one["call"], one["input"] = (float(one["time"]), float(one["value"]),
                                                                    int(one["call"]), str(one["input"]))
    except (ValueError, KeyError, TypeError) as error:
        raise Usage(f"{path}: is no log that a live page saved ({error}); save it again there") from error
    return log  # type: ignore[no-any-return]
