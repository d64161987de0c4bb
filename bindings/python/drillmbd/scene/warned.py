"""Everything that a scene should warn of, in the same words in each command: values that were assumed or look wrong,
pipes that were divided, settings for which a result is empty, and the warnings of the model check."""
from __future__ import annotations

import re

from ..language import Foreign, phrase
from ..sim import Sim
from . import words
from .content import Scene
from .doubtful import doubtful


def warnings_of(scene: Scene) -> list[str]:
    """One line each."""
    with scene.new_sim() as sim:
        return [phrase("line {line}: {place}: {text}", line=one.line, place=one.place, text=Foreign(one.text))
                for one in scene.remarks] + [one.text() for one in scene.divided] + \
            [phrase("not assessed: {reason}", reason=one) for one in words.trivial(scene)] + \
            doubtful(scene) + of_model(sim)


def of_model(sim: Sim) -> list[str]:
    """The warnings of the model check."""
    if not sim.check().warnings:
        return []
    listed = sim.check_text().partition("  warnings:\n")[2]
    return [Foreign(re.sub(r"\s+", " ", line.strip())) for line in listed.splitlines() if line.strip()]
