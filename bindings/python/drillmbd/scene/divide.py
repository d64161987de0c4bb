"""The number of elements of pipes for which a scene file gives none."""
from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from .lines import Path

if TYPE_CHECKING:
    from .content import Scene

MOST_ERROR = 0.01      #: of the yield strength, in the bending stress of a string that lies on the wall
MOST_ELEMENTS = 1024


@dataclass
class Divided:
    """Equal pipes of a string that are divided into elements."""
    string: str
    path: Path
    first: int          #: number of the first one along the string, 0 at the rig end
    count: int
    elements: int = 1
    error: float = 0.0  #: estimated error of one element a pipe, over the yield strength

    def __str__(self) -> str:
        last = self.first + self.count - 1
        pipes = f"pipe {self.first}" if self.count == 1 else f"pipes {self.first} to {last}"
        return (f"{self.string}, {pipes}: divided into {self.elements} elements each, because one element would have an estimated "
                f"error of {100.0 * self.error:.2g} % of the yield strength in the bending stress; set elements to choose another number")


def divide(scene: Scene, pipes: list[Divided], content: dict[str, Any]) -> bool:
    """Sets the elements of pipes whose estimated error exceeds MOST_ERROR, here and in the content of the file. Returns
    whether any are divided."""
    errors = {name: scene.model.mesh_errors(scene.names[name], scene.pipes[name]) for name in {one.string for one in pipes}}
    for one in pipes:
        one.error = max(errors[one.string][one.first:one.first + one.count])
        one.elements = min(MOST_ELEMENTS, max(1, math.ceil(math.sqrt(one.error / MOST_ERROR))))
        if one.elements > 1:
            _section(content, one.path)["elements"] = one.elements
    return any(one.elements > 1 for one in pipes)


def _section(content: Any, path: Path) -> dict[str, Any]:
    for part in path:
        content = content[part]
    return content  # type: ignore[no-any-return]
