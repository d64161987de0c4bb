"""Progress and end of long calls: by a function of the caller, or by Ctrl-C."""
from __future__ import annotations

import contextlib
import signal
import threading
from collections.abc import Callable, Iterator
from ctypes import c_void_p, cast
from typing import Any

from ._library import lib as _lib
from ._structs import PROGRESS_FN, STEP_FN

_NOBODY = cast(c_void_p(), PROGRESS_FN)
_NO_STEP = cast(c_void_p(), STEP_FN)


class Interrupts:
    """Ctrl-C of the command. Python raises KeyboardInterrupt wherever it is, and loses it where a package ignores
    exceptions, as while it is imported; so each is noted here until it is dealt with."""

    def __init__(self) -> None:
        self.pending = False
        self.holding = False
        self.torn = False   #: raised while held: what was held is half done

    def __call__(self, number: int, frame: Any) -> None:
        again, self.pending = self.pending, True
        if self.holding and not again:
            return
        self.torn = self.holding
        signal.default_int_handler(number, frame)

    @contextlib.contextmanager
    def held(self) -> Iterator[None]:
        """The first Ctrl-C is only noted within, for a loop that ends where its data are consistent; the next one ends
        it at once."""
        self.holding, self.torn = True, False
        try:
            yield
        finally:
            self.holding = False

    def install(self) -> None:
        """Notes Ctrl-C from now on, where it would end the program."""
        if (threading.current_thread() is threading.main_thread()
            and signal.getsignal(signal.SIGINT) is signal.default_int_handler):
            signal.signal(signal.SIGINT, self)

    def check(self) -> None:
        """Raises one that was lost."""
        if self.pending:
            raise KeyboardInterrupt


INTERRUPTS = Interrupts()


class Teller:
    """The C function of a sim's progress. It has no reference to the sim, which owns it."""

    def __init__(self) -> None:
        self.function: Callable[[float], Any] | None = None
        self.raised: BaseException | None = None
        self.interrupted = False

        def call(_context: Any, fraction: float) -> int:
            try:
                return 1 if self.interrupted or (self.function is not None and self.function(fraction)) else 0
            except BaseException as error:  # must not unwind through C
                self.raised = error
                return 1

        self.call = PROGRESS_FN(call)
        self.on_step: Callable[[float], Any] | None = None
        self.ended = False  # the function of accepted steps has ended a call

        def stepped(_context: Any, sim: Any) -> int:
            try:
                ends = self.on_step is not None and bool(self.on_step(float(_lib.dmb_sim_time(sim))))
            except BaseException as error:  # must not unwind through C
                self.raised, ends = error, True
            self.ended = self.ended or ends
            return 1 if ends else 0

        self.step_call = STEP_FN(stepped)

    def set(self, handle: c_void_p, function: Callable[[float], Any] | None) -> int:
        """The status of setting this function."""
        status = int(_lib.dmb_sim_set_progress(handle, _NOBODY if function is None else self.call, None))
        if status >= 0:
            self.function = function
        return status

    def set_on_step(self, handle: c_void_p, function: Callable[[float], Any] | None) -> int:
        """The status of setting this function of accepted steps."""
        status = int(_lib.dmb_sim_set_on_step(handle, _NO_STEP if function is None else self.step_call, None))
        if status >= 0:
            self.on_step = function
        return status

    def rethrow(self) -> None:
        """Raises the exception of the function in the last call."""
        raised, self.raised = self.raised, None
        if raised is not None:
            raise raised

    def _interrupt(self, _number: int, _frame: Any) -> None:
        self.interrupted = True

    def long_call(self, handle: c_void_p, function: Any, *arguments: Any) -> int:
        """The status of a call that Ctrl-C ends; KeyboardInterrupt if it has. Python's own handler would raise where C
        has called, or not before the call has ended."""
        usual: Any = signal.getsignal(signal.SIGINT)
        if (threading.current_thread() is not threading.main_thread() or (usual is not signal.default_int_handler
                                                                          and usual is not INTERRUPTS)):
            return int(function(handle, *arguments))
        INTERRUPTS.check()
        self.interrupted = False
        signal.signal(signal.SIGINT, self._interrupt)
        try:
            if self.function is None:
                _lib.dmb_sim_set_progress(handle, self.call, None)
            status = int(function(handle, *arguments))
        finally:
            if self.function is None:
                _lib.dmb_sim_set_progress(handle, _NOBODY, None)
            signal.signal(signal.SIGINT, usual)
        if self.interrupted:
            self.interrupted = False
            raise KeyboardInterrupt
        return status
