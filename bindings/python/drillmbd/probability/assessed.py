"""Failures that no sample of a scene can show, so that "0 of 1000 failed" would be no statement about the hole."""
from __future__ import annotations

from typing import Any

from ..enums import RX
from ..errors import Error
from ..operating import has_rock_law, operating
from ..scene import CannotSave, Scene, SceneError, loads
from ..scene.failure import Failure
from .draw import CannotDraw
from .limits import Course
from .sampling import stream

TRIES = 5  #: samples drawn at random, of which one must be readable
TURNS = ("bit-stuck", "stick-slip")
BEARS = ("lock-up", "bit-off-bottom")
TORQUES = ("rig-torque", "connection-torque", "back-off")


class Assessed:
    """The scene as it is written and as one sample has it."""

    def __init__(self, sample: Any) -> None:
        self.question = sample.question
        self.scenes: list[Scene] = [sample.draw.scene, *_drawn(sample)]
        self.plans = [operating(one) for one in self.scenes]

    @property
    def still(self) -> bool:
        """No drive of rotation ever turns, or there is none."""
        if not any(name == "add_drive" and arguments[0].get("component") == RX
                   for name, arguments in self.scenes[0].model.calls):
            return True
        return all(plan.rotation == 0.0 for plan in self.plans)

    @property
    def unloaded(self) -> bool:
        """The bit bears nothing."""
        return not any(plan.weight_on_bit for plan in self.plans) and not has_rock_law(self.scenes[0])

    def reason(self, one: Failure) -> str:
        """Why a failure is not assessed; "" where it is."""
        if one.kind in TURNS and self.still:
            return "no drive of rotation turns in this scene; give one a time function with a speed"
        if one.kind in BEARS and self.unloaded:
            return "the scene gives the bit no load; set load in [[bit]], or a rock law"
        if one.kind == "leaves-seam" and not any(Course(self.scenes[0]).off(other) for other in self.scenes[1:]):
            return ("nothing that varies changes the course of the hole; let the survey vary, as key = "
                    "\"hole.survey.inclination\" in [[variability.field]]")
        return ""

    def refuse(self, failures: list[Failure]) -> None:
        """Raises CannotDraw for the first that is not assessed."""
        for one in failures:
            reason = self.reason(one)
            if reason:
                raise CannotDraw(f"{one.name} ({one.kind}): not assessed, because {reason}. Or take the failure out")

    def notes(self, failures: list[Failure]) -> list[str]:
        """Parts that the estimates leave out."""
        torques = [one.name for one in failures if one.kind in TORQUES]
        if self.question == "run" and self.still and torques:
            return [f"{', '.join(torques)}: torque of rotation is not assessed, because no drive of rotation turns in "
                    "this scene"]
        return []


def _drawn(sample: Any) -> list[Scene]:
    """The scene of a sample that can be read."""
    for number in range(TRIES):
        values = sample.draw.values(stream(21, number).standard_normal(sample.dimension))
        try:
            return [loads(sample.text, sample.name, sample.folder,
                          {**sample.overrides, **sample.draw.overrides(values)})]
        except (Error, SceneError, CannotSave, ArithmeticError, ValueError):
            continue
    return []
