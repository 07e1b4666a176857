"""Makes the robot of a compiled MJCF file.

MuJoCo refuses a file that is wrong. Geometry that satcheck does not check is an unreadable body.
"""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

from satcheck.plugins.mjcf.exemptions import Exemptions, Mask
from satcheck.plugins.mjcf.joints import joints_of, pose_of, rest_poses, values_of
from satcheck.plugins.mjcf.messages import FileMesh, Flex, Geom, Model, OwnMesh
from satcheck.scene.bodies import IDENTITY
from satcheck.scene.issue import Issue, issue
from satcheck.scene.loading.raw_mesh import Refusal
from satcheck.scene.read_options import GeometryKind
from satcheck.scene.robot.kinematics import inverse
from satcheck.scene.robot.model import (
    Collision,
    Geometry,
    Link,
    MeshReference,
    Robot,
    State,
)

_FLEX = Refusal("unsupported-feature", "a deformable body (flex) is not read")


def robot_of_model(
    path: str, model: Model, geometry: GeometryKind = "collision", *, hulls: bool = False
) -> tuple[Robot, tuple[Issue, ...]]:
    """The robot, and issues.

    path: of the file. geometry: "collision": geoms whose contype or conaffinity is not 0, or that a
    <pair> names; "visual": the others. hulls: their meshes are convex hulls.
    """
    return _Reader(path, model, geometry, hulls=hulls).read()


class _Reader:
    def __init__(self, path: str, model: Model, geometry: GeometryKind, *, hulls: bool) -> None:
        self._path = path
        self._model = model
        self._geometry = geometry
        self._hulls = hulls and geometry == "collision"
        self._paired = {geom for pair in model.pairs for geom in pair}
        self._checked = [
            (number, geom)
            for number, geom in enumerate(model.geoms)
            if self._is_solid(number, geom) == (geometry == "collision")
        ]
        self._flexes = [
            flex for flex in model.flexes if geometry == "visual" or _mask(flex).collides
        ]
        solid: list[Geom | Flex] = [*(geom for _, geom in self._checked), *self._flexes]
        masks = [_mask(one) for one in solid] if geometry == "collision" else []
        self._exemptions = Exemptions(model, masks)

    def read(self) -> tuple[Robot, tuple[Issue, ...]]:
        model = self._model
        joints, between = joints_of(model)
        links = [*self._links(), *between, *self._flex_links()]
        states = tuple(
            State("", key.name, dict(values_of(key, model.joints)), self._path, {})
            for key in model.keys
        )
        roots = {link.name: IDENTITY for link in (links[0], *self._flex_links())}
        robot = Robot(
            name=model.name or Path(self._path).stem,
            file=self._path,
            roots=roots,
            links={link.name: link for link in links},
            joints=tuple(joints),
            exempt=self._exemptions.exempt(),
            geometry=self._geometry,
            states=states,
        )
        return robot, tuple(self._issues())

    def _is_solid(self, number: int, geom: Geom) -> bool:
        return _mask(geom).collides or number in self._paired

    def _links(self) -> Iterator[Link]:
        rest = rest_poses(self._model.bodies)
        of_body: dict[int, list[Collision]] = {}
        for number, geom in self._checked:
            of_body.setdefault(geom.body, []).append(self._collision(number, geom))
        checked = {number for number, _ in self._checked}
        others = {g.body for k, g in enumerate(self._model.geoms) if k not in checked}
        for number, body in enumerate(self._model.bodies):
            yield Link(
                name=body.name,
                collisions=tuple(of_body.get(number, ())),
                unused=number in others,
                static=body.static,
                rest=rest[number],
            )

    def _flex_links(self) -> list[Link]:
        links = []
        for flex in self._flexes:
            groups = self._exemptions.groups(None, _mask(flex))
            lost = Collision(None, IDENTITY, _FLEX, 0, groups=groups)
            links.append(Link(f"flex {flex.name}", (lost,), unused=False))
        return links

    def _collision(self, number: int, geom: Geom) -> Collision:
        body = self._model.bodies[geom.body]
        return Collision(
            name=geom.name,
            origin=pose_of(geom.place),
            geometry=self._shape(geom),
            line=geom.line,
            groups=self._exemptions.groups(body, _mask(geom), number),
        )

    def _shape(self, geom: Geom) -> Geometry:
        match geom.shape:
            case OwnMesh(part):
                own = Path(self._path).name
                return MeshReference(own, (1.0, 1.0, 1.0), part=part, hull=self._hulls)
            case FileMesh(file, scale, place):
                start = inverse(pose_of(place))
                return MeshReference(file, scale, start=start, hull=self._hulls)
        return geom.shape

    def _issues(self) -> Iterator[Issue]:
        meshes = any(isinstance(geom.shape, FileMesh | OwnMesh) for _, geom in self._checked)
        if meshes and self._geometry == "collision":
            yield issue("mesh-or-hull", self._which_is_checked(), file=self._path)
        for code, message in self._model.notes:
            yield issue(code, message, file=self._path)

    def _which_is_checked(self) -> str:
        if self._hulls:
            return "the convex hulls of meshes are checked, as in MuJoCo, not their triangles"
        return "the triangles of meshes are checked; MuJoCo uses their convex hulls (--mesh-hulls)"


def _mask(one: Geom | Flex) -> Mask:
    return Mask(one.contype, one.conaffinity)
