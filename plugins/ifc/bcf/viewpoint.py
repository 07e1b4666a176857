"""The camera and the picture of a pair. Both show the same: a parallel projection of the pair."""

from __future__ import annotations

from typing import TYPE_CHECKING
from xml.etree.ElementTree import Element

import numpy as np
from msgspec import Struct
from msgspec.structs import replace

from satcheck.cli.formats.picture.data import up_of
from satcheck.cli.formats.picture.png import View, image_of, view_of
from satcheck.plugins.ifc.bcf.text import below, document, point
from satcheck.scene.units import ratio, stated_unit

if TYPE_CHECKING:
    from collections.abc import Sequence

    import numpy.typing as npt

    from satcheck.plugins.ifc.bcf.topics import Member, PairView
    from satcheck.scene import Body, Scene

    Floats = npt.NDArray[np.float64]

SIZE = (800, 600)  # of a picture, in pixels
COLOURS = ("2970D6", "E68C1A")  # of A and B, as in the pictures: red, green, blue
_UNIT = "m"  # of BCF
# From y up to z up, the axes of BCF: (x, y, z) becomes (x, -z, y).
_Z_UP = np.array([[1.0, 0.0, 0.0], [0.0, 0.0, -1.0], [0.0, 1.0, 0.0]])


class Seen(Struct, frozen=True):
    """eye, direction, up: of the camera, metres, z up. height: of what the image shows, metres.
    image: PNG."""

    eye: tuple[float, float, float]
    direction: tuple[float, float, float]
    up: tuple[float, float, float]
    height: float
    image: bytes


class Snapshots:
    """Pictures of the pairs of a scene."""

    def __init__(self, scene: Scene) -> None:
        self._scene = scene
        self._up = up_of(scene)
        self._axes = _Z_UP if self._up == "y" else np.eye(3)
        unit = stated_unit(scene.units)
        self._metres = 1.0 if unit is None else ratio(unit, _UNIT)
        self._bodies = {body.id: body for body in scene.bodies}
        boxes = [body.world_mesh().bounds for body in scene.bodies]
        self._boxes: Floats = np.array(boxes).reshape(-1, 2, 3)

    def of(self, shown: PairView) -> Seen | None:
        """None: no body of the pair can be drawn."""
        pair = [self._bodies[m.id] for m in shown.members if m.id in self._bodies]
        if not pair:
            return None
        view = view_of(pair, len(pair) == 2, self._up, SIZE)
        near = replace(self._scene, bodies=tuple(self._near(view)))
        finding = shown.finding if len(pair) == 2 else None
        if finding is None:
            near = replace(near, bodies=tuple(pair))
        image = image_of(near, finding, pair, view, SIZE)
        return self._seen(view, pair, image)

    def _near(self, view: View) -> list[Body]:
        """The bodies that may be in the image."""
        reach = np.hypot(*SIZE) / 2 / view.scale
        low, high = self._boxes[:, 0], self._boxes[:, 1]
        near = ((low <= view.target + reach) & (high >= view.target - reach)).all(axis=1)
        return [self._scene.bodies[k] for k in np.flatnonzero(near)]

    def _seen(self, view: View, pair: Sequence[Body], image: bytes) -> Seen:
        """The eye stands before the bodies, so that no wall is between."""
        _, up, towards = view.rows
        points = np.concatenate([np.asarray(body.world_mesh().bounds) for body in pair])
        height = SIZE[1] / view.scale
        corners = np.array(np.meshgrid(*zip(points.min(axis=0), points.max(axis=0), strict=True)))
        ahead = ((corners.reshape(3, -1).T - view.target) @ towards).max()
        eye = view.target + towards * (ahead + height)
        return Seen(
            eye=self._placed(eye * self._metres),
            direction=self._placed(-towards),
            up=self._placed(up),
            height=float(height * self._metres),
            image=image,
        )

    def _placed(self, vector: Floats) -> tuple[float, float, float]:
        """In the axes of BCF."""
        x, y, z = map(float, self._axes @ vector + 0.0)
        return x, y, z


def visualization(view: PairView, seen: Seen) -> bytes:
    root = Element("VisualizationInfo", Guid=view.guid)
    components = below(root, "Components")
    selection = below(components, "Selection")
    for member in view.members:
        _component(selection, member)
    visibility = below(components, "Visibility", DefaultVisibility="true")
    hints = ("SpacesVisible", "SpaceBoundariesVisible", "OpeningsVisible")
    below(visibility, "ViewSetupHints", **dict.fromkeys(hints, "false"))
    colouring = below(components, "Coloring")
    for member, colour in zip(view.members, COLOURS, strict=True):
        _component(below(below(colouring, "Color", Color=colour), "Components"), member)
    camera = below(root, "OrthogonalCamera")
    point(camera, "CameraViewPoint", seen.eye)
    point(camera, "CameraDirection", seen.direction)
    point(camera, "CameraUpVector", seen.up)
    below(camera, "ViewToWorldScale", repr(seen.height))
    below(camera, "AspectRatio", repr(SIZE[0] / SIZE[1]))
    return document(root)


def _component(parent: Element, member: Member) -> None:
    """Programs find an element by its GlobalId only."""
    if member.guid is None:
        below(parent, "Component", AuthoringToolId=member.id)
    else:
        below(parent, "Component", IfcGuid=member.guid)
