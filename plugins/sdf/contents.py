"""Collects what an SDFormat file and the files that it includes declare: models, links, joints and
frames, by their paths `model::nested::name`."""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

from satcheck.plugins.sdf import places
from satcheck.plugins.sdf.elements import boolean, flag, frame_named, pose_of, text_of
from satcheck.plugins.sdf.frames import WORLD, Frame, Frames, Name, Scope
from satcheck.plugins.sdf.includes import Includes, name_in, version_of
from satcheck.plugins.sdf.joints import JointEntry
from satcheck.scene.bodies import IDENTITY
from satcheck.scene.document import Refusal
from satcheck.scene.errors import Refused
from satcheck.scene.files.xml_tree import Element
from satcheck.scene.robot.model import Collision
from satcheck.scene.robot.slips import Slips

MOST_NESTED = 64  # models in each other
_EARLIEST = (1, 2)  # earlier versions write values as attributes
_ONLY_IN_MODELS = ("link", "collision", "visual")
_MERGED = "_merged__{}__model__"  # the frame of a model that becomes part of the one around


class Around(NamedTuple):
    """What a model hands down to its contents. model: the outermost one. files: those that are
    being read, to find circles of includes."""

    scope: Scope
    version: tuple[int, ...]
    model: str = ""
    static: bool = False
    self_collide: bool = False
    depth: int = 0
    files: tuple[str, ...] = ()


class LinkEntry(NamedTuple):
    """model: the outermost one. self_collide: the link is checked against other links of this
    model. refusal: why there is no such link; the body stands for what is not read."""

    element: Element
    scope: Scope
    model: str
    static: bool
    self_collide: bool
    refusal: Collision | None = None


class Contents:
    """links, joints: of all models. models: path -> the canonical link if the model names one."""

    def __init__(self, includes: Includes, slips: Slips) -> None:
        self._includes = includes
        self.slips = slips
        self.frames = Frames()
        self.links: dict[str, LinkEntry] = {}
        self.joints: list[JointEntry] = []
        self.models: dict[str, Name | None] = {}
        self._first: dict[str, str] = {}  # model -> its first link
        self._readers: dict[str, Callable[[Element, Around], None]] = {
            "model": self._model,
            "include": self._include,
            "link": self._link,
            "frame": self._frame,
            "joint": self._joint,
            "actor": self._actor,
            "population": self._unread,
            "road": self._unread,
            "state": self._state,
        }

    def read(self, root: Element) -> None:
        """Reads a file. Raises Refused."""
        around = Around(Scope(), _version(root), files=(root.file,))
        worlds = root.all("world")
        if len(worlds) > 1:
            worlds[1].refuse("a second <world>: check each in a file of its own")
        self.slips.look(root, places.ROOT)
        for world in worlds:
            self.slips.look(world, places.WORLD)
        for container in (root, *worlds):
            for tag in _ONLY_IN_MODELS:
                for element in container.all(tag):
                    element.refuse(f"should be in a model, not in <{container.tag}>")
            self._all_in(container, around)

    def _all_in(self, container: Element, around: Around) -> None:
        """Frames and joints come last: one that shares its name with a link or a model gets another
        name."""
        last = ("frame", "joint")
        rank = {tag: number for number, tag in enumerate(last, 1)}
        for child in sorted(container.children, key=lambda child: rank.get(child.tag, 0)):
            if child.tag in self._readers:
                self._readers[child.tag](child, around)

    def _model(self, element: Element, around: Around, include: Element | None = None) -> None:
        """include: names the model, and says more about it."""
        if around.depth >= MOST_NESTED:
            element.refuse(f"more than {MOST_NESTED} models in each other", "too-large")
        self.slips.look(element, places.MODEL)

        def stated(tag: str) -> Element | None:
            return include.only(tag) if include else None

        named, frame = stated("name"), stated("placement_frame")
        name = (named and named.text) or element.attribute("name")
        merge = include is not None and flag(include, "merge")
        path = around.scope.path(_MERGED.format(name) if merge else name)
        scope = Scope(around.scope.prefix if merge else path, path)
        placement = frame.text if frame else element.attributes.get("placement_frame")
        place = None if not placement else Name(scope, placement, element)
        pose = stated("pose") or element.only("pose")
        self._declare(path, element, pose, around.scope, place=place)
        first = element.attributes.get("canonical_link")
        self.models[path] = Name(scope, first, element) if first else None
        static = stated("static") or element.only("static")
        if merge and not around.scope.prefix:
            for link in element.all("link"):
                link.refuse("a link of a model that is merged into the world")
        within = around._replace(
            scope=scope,
            model=around.model or scope.prefix,
            static=around.static or boolean(element, "static", False, static),
            self_collide=boolean(element, "self_collide", around.self_collide),
            depth=around.depth + 1,
        )
        self._all_in(element, within)

    def _declare(
        self,
        path: str,
        element: Element,
        pose: Element | None,
        scope: Scope,
        *,
        attached: Name | None = None,
        place: Name | None = None,
    ) -> None:
        """scope: in which the pose names frames. attached: what the frame moves with, and is
        relative to if the pose names no frame; None: the model."""
        parent = frame_named(pose, scope) or attached or scope.model
        frame = Frame(element, parent, pose_of(pose), attached or scope.model, place)
        self.frames.declare(path, frame)

    def _include(self, element: Element, around: Around) -> None:
        self.slips.look(element, places.INCLUDE)
        uri = text_of(element, "uri")
        named = element.only("name")
        name = (named.text if named else "") or name_in(uri)
        changes = [child for child in element.children if child.tag.endswith(":params")]
        try:
            if changes:
                message = f"<{changes[0].tag}> changes the model: not read"
                raise Refused("unsupported-feature", message)
            root = self._includes.document(uri, element.file)
        except Refused as error:
            self._lose(element, around, name, error.code, uri, error.message)
            return
        if root.file in around.files:
            element.refuse(f"{uri!r} includes itself", "reference-cycle")
        within = around._replace(version=_version(root), files=(*around.files, root.file))
        models, worlds, actors = map(root.all, ("model", "world", "actor"))
        for model in models[:1]:
            self._model(model, within, element)
        for other in [*models[1:], *worlds][:1]:
            why = f"its <{other.tag}> of line {other.line} is not read: only a first model is"
            self._lose(element, around, name, "unsupported-feature", uri, why)
        for actor in actors:
            self._actor(actor, within)
        if not (models or worlds or actors or root.all("light")):
            self._lose(element, around, name, "not-this-format", uri, "it has no <model>")

    def _lose(
        self, element: Element, around: Around, name: str, code: str, what: str, why: str
    ) -> None:
        """Puts a body that cannot be checked in the place of what is not read."""
        path, number = around.scope.path(name), 1
        while path in self.frames:
            number += 1
            path = around.scope.path(f"{name}-{number}")
        self._declare(path, element, element.only("pose"), around.scope)
        self.frames.opaque.add(path)
        # What is not read may be checked against the links around it, so its pairs stay open.
        reason = Refusal(code, f"<{element.tag}>: {what!r} is not read: {why}")
        body = Collision(None, IDENTITY, reason, element.line, element.file)
        model = around.model or path
        self.links[path] = LinkEntry(element, around.scope, model, around.static, True, body)

    def _link(self, element: Element, around: Around) -> None:
        if around.scope.model == WORLD:
            return
        self.slips.look(element, places.LINK)
        path = around.scope.path(element.attribute("name"))
        self._declare(path, element, element.only("pose"), around.scope)
        alone = boolean(element, "self_collide", around.self_collide)
        self.links[path] = LinkEntry(element, around.scope, around.model, around.static, alone)
        self._first.setdefault(around.scope.model, path)

    def _frame(self, element: Element, around: Around) -> None:
        self.slips.look(element, places.FRAME)
        path = self._free_path(element, around.scope)
        text = element.attributes.get("attached_to")
        attached = Name(around.scope, text, element) if text else None
        pose = element.only("pose")
        self._declare(path, element, pose, around.scope, attached=attached)

    def _joint(self, element: Element, around: Around) -> None:
        self.slips.look(element, places.JOINT)
        path = self._free_path(element, around.scope)
        parent, child = (
            Name(around.scope, text_of(element, role), element.need(role), of_joint=True)
            for role in ("parent", "child")
        )
        pose = element.only("pose")
        self._declare(path, element, pose, around.scope, attached=child)
        moves = not around.static
        joint = JointEntry(element, path, around.scope, around.version, parent, child, moves)
        self.joints.append(joint)

    def _free_path(self, element: Element, scope: Scope) -> str:
        """The path of a frame or a joint, which ends in the tag if something else has the name, as
        in libsdformat."""
        path = scope.path(element.attribute("name"))
        taken = path in self.frames and self.frames.element(path).tag != element.tag
        return f"{path}_{element.tag}" if taken else path

    def _actor(self, element: Element, around: Around) -> None:
        for link in element.all("link"):
            self.slips.look(link, places.LINK)
        solid = any(link.all("collision") for link in element.all("link"))
        if solid or self.slips.geometry == "visual":
            name, why = element.attribute("name"), "a script moves it"
            self._lose(element, around, name, "unsupported-feature", name, why)
        else:
            cause = "an <actor> without <collision>: no body is checked"
            self.slips.note("no-collision-geometry", element, cause)

    def _unread(self, element: Element, around: Around) -> None:
        name, is_road = element.attributes.get("name") or element.tag, element.tag == "road"
        why = "a road has no mesh" if is_road else "it places models by chance"
        if not is_road or self.slips.geometry == "visual":
            self._lose(element, around, name, "unsupported-feature", name, why)

    def _state(self, element: Element, _: Around) -> None:
        self.slips.look(element, places.STATE)
        if element.all("model"):
            cause = "a stored <state> is not applied: models stand where <model> places them"
            self.slips.note("stored-state", element, cause)

    def body(self, name: Name | str) -> str:
        """The link that a frame moves with; WORLD if it does not move. Raises Refused."""
        path, passed = self.frames.find(name), set[str]()
        while path != WORLD and path not in self.links:
            if path in passed:
                element = self.frames.element(path)
                element.refuse(f"{path!r} is indirectly attached to itself", "reference-cycle")
            passed.add(path)
            path = self._next(path)
        return path

    def _next(self, path: str) -> str:
        if path in self.models:
            named = self.models[path]
            return self._canonical(path) if named is None else self.frames.find(named)
        return self.frames.attached_to(path)

    def _canonical(self, model: str) -> str:
        """The first link of a model, else that of the models in it."""
        deeper = (path for path in self.links if path.startswith(f"{model}::"))
        first = self._first.get(model) or next(deeper, None)
        return first or self.frames.element(model).refuse("a model without links")


def _version(root: Element) -> tuple[int, ...]:
    version = version_of(root)
    if version < _EARLIEST:
        text = ".".join(map(str, version))
        message = f"SDFormat {text} is not read: convert the file first (gz sdf --convert FILE)"
        root.refuse(message, "unsupported-feature")
    return version
