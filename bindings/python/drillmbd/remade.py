"""Scenes whose model is described again with something changed: time functions, drives, inputs."""
from __future__ import annotations

from dataclasses import replace
from typing import Any

from .model import remake
from .scene import Scene

Calls = list[tuple[str, tuple[Any, ...]]]


def number_of(part: Any) -> int:
    """The number of a part among those of its kind."""
    return int(part.index) & 0xFFFFFF


def with_calls(scene: Scene, calls: Calls) -> Scene:
    """The scene with a model that these calls describe. Parts keep their numbers."""
    return _with_model(scene, remake(type(scene.model), calls))


def with_time_functions(scene: Scene, segments: dict[int, list[dict[str, Any]]]) -> Scene:
    """The scene with other segments of the time functions of these numbers."""
    calls, number = [], 0
    for name, arguments in scene.model.calls:
        if name == "add_time_function":
            arguments = tuple(segments.get(number, arguments))
            number += 1
        calls.append((name, arguments))
    return with_calls(scene, calls)


def rebound(scene: Scene) -> Scene:
    """A scene that came through pickle, with the parts of its own model."""
    return _with_model(scene, scene.model)


def _with_model(scene: Scene, model: Any) -> Scene:
    return replace(scene, model=model, names=model.own(scene.names), outputs=model.own(scene.outputs),
                   analyses=model.own(scene.analyses))


def time_functions_of(scene: Scene) -> list[Any]:
    """The segments of all time functions, by number."""
    return [segments for name, segments in scene.model.calls if name == "add_time_function"]
