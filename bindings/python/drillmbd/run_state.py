"""The state of a run in time, kept in the folder of its results, from which the same command continues after Ctrl-C, or
after the machine went down. It is written whole or not at all, and is gone when the run is complete."""
from __future__ import annotations

import hashlib
import io
import json
import os
import time
import zipfile
from collections.abc import Callable
from typing import Any, Protocol

from ._optional import need
from ._progress import INTERRUPTS
from .results import CommandOutput
from .errors import Error, Usage
from .language import Phrase, phrase
from .probability.study import code
from .scene import CannotSave, Scene, saves
from .sim import Sim

FILE = "run_state.npz"
EVERY = 60.0          #: [s] by the clock between two states that are kept without a request
MOST_BYTES = 2 ** 28  #: of a state that is kept so often; larger ones only after Ctrl-C


class Kept(Protocol):
    """Part of a run that counts: recorder, fatigue, energy of the first tenth, ..."""

    def keep(self) -> dict[str, Any]:
        """Numbers, texts and lists of them, bytes, arrays of numpy."""

    def take_up(self, kept: dict[str, Any]) -> None:
        """Continues from the state that another one of the same run has stored."""


class KeptRecorder:
    """The rows of a recorder."""

    def __init__(self, recorder: Any) -> None:
        self.recorder = recorder

    def keep(self) -> dict[str, Any]:
        """A copy of the rows."""
        return {"table": need("numpy").array(self.recorder.table)}

    def take_up(self, kept: dict[str, Any]) -> None:
        """Writes the rows."""
        self.recorder.take_up(kept["table"])


class KeptFatigue:
    """The counts of a string."""

    def __init__(self, counter: Any) -> None:
        self.counter = counter

    def keep(self) -> dict[str, Any]:
        """A copy of the counts."""
        return {"counts": self.counter.counter.snapshot()}

    def take_up(self, kept: dict[str, Any]) -> None:
        """Counts on."""
        self.counter.counter.restore(kept["counts"])


class RunState:
    """Keeps and finds the state of one run. Without a folder it does neither."""

    def __init__(self, scene: Scene, sim: Sim, out: CommandOutput, settings: list[Any]) -> None:
        self.sim, self.out = sim, out
        self.parts: dict[str, Kept] = {}
        self.path = None if out.folder is None else out.folder / FILE
        self.identity = "" if self.path is None else _identity(scene, [out.summary["command"], *settings])
        self.kept_at = time.monotonic()
        self.read = self._read()

    # ---- Going on ---------------------------------------------------------------------------------------------------
    @property
    def begun(self) -> bool:
        """Whether there is a stored state."""
        return self.read is not None

    def take_up(self, parts: dict[str, Kept]) -> dict[str, Any]:
        """Parts that are kept from now on. Where there is a state, sim and parts continue from it; its scalars."""
        self.parts = parts
        if self.read is None:
            return {}
        meta, arrays = self.read
        try:
            self.sim.restore(arrays["sim"].tobytes())
            for name, part in parts.items():
                part.take_up(_unpacked(meta["parts"][name], arrays))
            scalars = _unpacked(meta["scalars"], arrays)
        except (Error, KeyError, ValueError, TypeError) as error:
            raise Usage(f"{self.path}: cannot be read ({error}); remove it, and the run starts again") from None
        self.out.note_text(phrase("the run continues at {time:g} s, up to which it was computed before; remove {file} "
                                  "to start again", time=self.sim.time,
                                     file=str(self.path)))
        return scalars

    def _read(self) -> tuple[dict[str, Any], dict[str, Any]] | None:
        """Content of the file, if it is of this run."""
        if self.path is None or not self.path.is_file():
            return None
        try:
            with need("numpy").load(self.path, allow_pickle=False) as file:
                arrays = {name: file[name] for name in file.files}
            meta = json.loads(arrays.pop("meta").tobytes().decode())
            same = meta["identity"] == self.identity
        except (OSError, ValueError, KeyError, TypeError, EOFError, zipfile.BadZipFile):
            self._said(phrase("{file} cannot be read; the run starts again", file=str(self.path)))
            return None
        if same:
            return meta, arrays
        self._said(phrase("{file} is of another scene, other options or another version; the run starts again",
                          file=str(self.path)))
        return None

    def _said(self, text: Phrase) -> None:
        self.out.note_text(text)

    # ---- Keeping ----------------------------------------------------------------------------------------------------
    def keep(self, scalars: dict[str, Any], most: float = float("inf")) -> bool:
        """Writes the state, unless it has more bytes than `most`; False where it was not written."""
        if self.path is None or INTERRUPTS.torn:
            return False
        arrays: dict[str, Any] = {"sim": _bytes(self.sim.snapshot())}
        meta = {"identity": self.identity, "parts": {name: _packed(part.keep(), f"{name}/", arrays)
                                                     for name, part in self.parts.items()},
                "scalars": _packed(scalars, "scalars/", arrays)}
        if sum(one.nbytes for one in arrays.values()) > most:
            return False
        arrays["meta"] = _bytes(json.dumps(meta).encode())
        block = io.BytesIO()
        need("numpy").savez_compressed(block, **arrays)
        beside = self.path.with_name(self.path.name + ".part")
        beside.write_bytes(block.getbuffer())
        os.replace(beside, self.path)
        self.kept_at = time.monotonic()
        return True

    def sometimes(self, scalars: Callable[[], dict[str, Any]]) -> None:
        """Writes the state once a minute."""
        if time.monotonic() - self.kept_at > EVERY:
            self.keep(scalars(), MOST_BYTES)
            self.kept_at = time.monotonic()

    def stopped(self, end: float, scalars: dict[str, Any]) -> None:
        """After Ctrl-C: stores the state, and says how to continue."""
        time_, kept = self.sim.time, self.keep(scalars)
        text = (phrase("stopped by Ctrl-C at {time:g} s of {end:g} s; the same command continues from there",
                       time=time_, end=end) if kept else
                phrase("stopped by Ctrl-C at {time:g} s of {end:g} s; the same command starts again", time=time_,
                       end=end))
        self.out.stopped(text)

    def done(self) -> None:
        """The run is complete, its state is not needed any more."""
        if self.path is not None and self.path.is_file():
            self.path.unlink()


def _identity(scene: Scene, settings: list[Any]) -> str:
    """Of all that decides the results: scene, options, code. Units of the output do not."""
    try:
        text = saves(scene, False)
    except CannotSave:
        text = repr(scene.model.calls)
    return hashlib.sha256(json.dumps([text, settings, sorted(code().items())]).encode()).hexdigest()


def _bytes(block: bytes) -> Any:
    return need("numpy").frombuffer(block, dtype="uint8")


def _packed(values: dict[str, Any], prefix: str, arrays: dict[str, Any]) -> dict[str, Any]:
    """Values for JSON; bytes and arrays go to `arrays` and are named there."""
    found: dict[str, Any] = {}
    for name, value in values.items():
        if isinstance(value, bytes) or bool(getattr(value, "ndim", None)):
            arrays[prefix + name] = _bytes(value) if isinstance(value, bytes) else value
            found[name] = {"array": prefix + name, "bytes": isinstance(value, bytes)}
        else:
            found[name] = {"value": value}
    return found


def _unpacked(packed: dict[str, Any], arrays: dict[str, Any]) -> dict[str, Any]:
    return {name: one["value"] if "value" in one else arrays[one["array"]].tobytes() if one["bytes"]
            else arrays[one["array"]]
            for name, one in packed.items()}


def stop_requested(run: RunState, scalars: Callable[[], dict[str, Any]]) -> bool:
    """For the progress of Sim.run: True after Ctrl-C; keeps the state once a minute."""
    run.sometimes(scalars)
    return INTERRUPTS.pending
