"""The live page inside the report: packed, it begins when the reader asks for it."""
from __future__ import annotations

import base64
import gzip

from . import live
from .errors import Error, Usage
from .language import Foreign, Language, phrase
from .scene import Scene
from .verdict import NOT_COMPUTED, Tile


def packed_page(scene: Scene, file: str, to: Language) -> tuple[str, Tile | None]:
    """The packed page of a scene that was read from a file; "" and a tile with the reason where the scene or this
    machine cannot have one."""
    try:
        return base64.b64encode(gzip.compress(live.small_page(scene, file, to, True), 9, mtime=0)).decode(), None
    except (Error, Usage, ArithmeticError, OSError) as error:
        reason = error.message if isinstance(error, Error) else str(error)
        return "", Tile(phrase("Scene to run in this page"), phrase("not included"),
                        Foreign(reason.removeprefix("live page refused: ")), NOT_COMPUTED)
