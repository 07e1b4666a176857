"""The frames of an SDFormat file: models, links, joints and <frame>s, by their paths `a::b::c`.

Frames may be named before they are declared, so names are resolved when all are declared. The rules
are those of http://sdformat.org/tutorials?tut=pose_frame_semantics.
"""

from __future__ import annotations

from typing import NamedTuple

from satcheck.core.transform import Transform, compose
from satcheck.scene.bodies import IDENTITY
from satcheck.scene.files.xml_tree import Element, RefusedElement
from satcheck.scene.robot.kinematics import inverse
from satcheck.scene.words import meant

WORLD = ""  # the path of the world
_WORLD = "world"
_MODEL = "__model__"
_SEPARATOR = "::"
MOST_FRAMES = 100_000


class Scope(NamedTuple):
    """Where names are resolved. prefix: the path of the model around, WORLD outside of models.
    model: the frame that `__model__` means."""

    prefix: str = WORLD
    model: str = WORLD

    def path(self, name: str) -> str:
        return f"{self.prefix}{_SEPARATOR}{name}" if self.prefix else name


class Name(NamedTuple):
    """A frame by its name in a scope. element: which names it. of_joint: a joint may also name the
    world, and what is inside a model that is not read."""

    scope: Scope
    text: str
    element: Element
    of_joint: bool = False


class Frame(NamedTuple):
    """parent: the frame to which `pose` is relative. attached: what it moves with.
    placement: the frame of a model that stands at `pose`; None: the model's own."""

    element: Element
    parent: Name | str
    pose: Transform
    attached: Name | str
    placement: Name | None = None


class Frames:
    """opaque: models that are not read, and therefore have no known contents."""

    def __init__(self) -> None:
        self.opaque: set[str] = set()
        self._frames: dict[str, Frame] = {}
        self._worlds: dict[str, Transform] = {WORLD: IDENTITY}

    def __contains__(self, path: str) -> bool:
        return path in self._frames

    def declare(self, path: str, frame: Frame) -> None:
        element = frame.element
        if path in self._frames:
            other = self._frames[path].element
            place = f"line {other.line}" + (
                f" of {other.file}" if other.file != element.file else ""
            )
            element.refuse(f"a second {path!r}, the first is in {place}", "duplicate-id")
        if len(self._frames) >= MOST_FRAMES:
            element.refuse(f"more than {MOST_FRAMES} models, links and joints", "too-large")
        self._frames[path] = frame

    def element(self, path: str) -> Element:
        return self._frames[path].element

    def find(self, name: Name | str) -> str:
        """The path of the frame. Raises Refused if there is none."""
        if isinstance(name, str):
            return name
        scope, text, element, of_joint = name
        if text == _MODEL and scope.model:
            return scope.model
        path = scope.path(text)
        if path not in self._frames:
            path = path.removesuffix(_SEPARATOR + _MODEL)
        known = self._frames.get(path)
        names_body = known is not None and known.element.tag != "joint"
        if text == _WORLD and (of_joint or not scope.prefix) and not names_body:
            return WORLD
        if known is not None:
            return path
        parts = path.split(_SEPARATOR) if of_joint else []
        for length in range(1, len(parts)):
            if (model := _SEPARATOR.join(parts[:length])) in self.opaque:
                return model
        start = scope.path("")
        known_here = (name.removeprefix(start) for name in self._frames if name.startswith(start))
        hint = meant(text, list(known_here))
        message = f"names {text!r}, which does not exist{hint}"
        return element.refuse(message, "index-out-of-range")

    def knows(self, name: Name) -> bool:
        try:
            self.find(name)
        except RefusedElement:
            return False
        return True

    def attached_to(self, path: str) -> str:
        """What the frame moves with."""
        return self.find(self._frames[path].attached)

    def world(self, path: str) -> Transform:
        """The pose of the frame in the world. Raises Refused for circles."""
        chain: dict[str, None] = {}
        while path not in self._worlds:
            path = self._step(path, chain)
        for name in reversed(chain):
            self._worlds[name] = compose(self._worlds[path], self._in_parent(name))
            path = name
        return self._worlds[path]

    def between(self, path: str, ancestor: str) -> Transform:
        """The pose of a frame in an ancestor, from the poses on the way alone."""
        pose, chain = IDENTITY, dict[str, None]()
        while path != ancestor:
            if path == WORLD:
                start = next(iter(chain), WORLD)
                message = f"the pose of {start!r} does not depend on {ancestor!r}"
                self._frames[ancestor].element.refuse(message)
            pose = compose(self._in_parent(path), pose)
            path = self._step(path, chain)
        return pose

    def _in_parent(self, path: str) -> Transform:
        frame = self._frames[path]
        if frame.placement is None:
            return frame.pose
        placement = self.find(frame.placement)
        return compose(frame.pose, inverse(self.between(placement, path)))

    def _step(self, path: str, chain: dict[str, None]) -> str:
        """The parent of the frame, which is added to the chain. Raises Refused for
        circles."""
        if path in chain:
            names = [*chain]
            circle = " -> ".join(map(repr, (*names[names.index(path) :], path)))
            element = self._frames[path].element
            element.refuse(f"poses form a cycle: {circle}", "reference-cycle")
        chain[path] = None
        return self.find(self._frames[path].parent)
