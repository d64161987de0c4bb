"""The number of elements of pipes for which a scene file gives none."""
from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from ..language import Phrase, phrase
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
        return self.text()

    def text(self) -> Phrase:
        """The division and its reason."""
        last = self.first + self.count - 1
        pipes = (phrase("pipe {first}", first=self.first) if self.count == 1
                 else phrase("pipes {first} to {last}", first=self.first, last=last))
        return phrase("{string}, {pipes}: divided into {elements} elements each, because one element would have an "
                      "estimated error of {error:.2g} % of "
                      "the yield strength in the bending stress; set elements to choose another number",
                      string=self.string, pipes=pipes,
                      elements=self.elements, error=100.0 * self.error)


def divide(scene: Scene, pipes: list[Divided], content: dict[str, Any]) -> bool:
    """Sets the elements of pipes whose estimated error exceeds MOST_ERROR, here and in the content of the file. Returns
    whether any are divided."""
    errors = {name: scene.model.mesh_errors(scene.names[name], scene.pipes[name])
              for name in {one.string for one in pipes}}
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
