"""An object of the C library that Python owns."""
from __future__ import annotations

from ctypes import byref, c_void_p
from typing import Any, TypeVar

from ._library import lib as _lib
from ._parts import closed, is_closed
from .errors import check

H = TypeVar("H", bound="Handle")


class Handle:
    """Gives its C object back at the end of a with block, by close(), or when Python drops it."""
    _handle: c_void_p
    _kind = ""  #: dmb_<kind>_destroy gives it back

    def close(self) -> None:
        """Frees the memory; later calls raise Error. Sims of a model stay valid."""
        if getattr(self, "_handle", None) is not None and _lib is not None:
            getattr(_lib, f"dmb_{self._kind}_destroy")(byref(self._handle))

    def _sure(self, status: int) -> int:
        """The status of a call, or its Error."""
        if is_closed(self._handle, status):
            raise closed(self._kind.replace("_", " "))
        return check(status)

    def __enter__(self: H) -> H:
        return self

    def __exit__(self, *_: Any) -> None:
        self.close()

    def __del__(self) -> None:
        self.close()
