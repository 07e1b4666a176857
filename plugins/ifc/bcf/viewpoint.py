"""The camera and the picture of a pair. Both show the same: a parallel projection of the pair."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from bcf.v3 import model as bcf
from msgspec.structs import replace

from satcheck.cli.formats.picture.data import up_of
from satcheck.cli.formats.picture.png import View, image_of, view_of
from satcheck.scene.units import ratio, stated_unit

if TYPE_CHECKING:
    from collections.abc import Sequence

    import numpy.typing as npt

    from satcheck.plugins.ifc.bcf.topics import Member, Pair
    from satcheck.scene import Body, Scene

    Floats = npt.NDArray[np.float64]

SIZE = (800, 600)  # of a picture, in pixels
COLOURS = ("2970D6", "E68C1A")  # of A and B, as in the pictures: red, green, blue
_UNIT = "m"  # of BCF
# From y up to z up, the axes of BCF: (x, y, z) becomes (x, -z, y).
_Z_UP = np.array([[1.0, 0.0, 0.0], [0.0, 0.0, -1.0], [0.0, 1.0, 0.0]])


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

    def of(self, shown: Pair) -> tuple[Any, bytes] | None:
        """The viewpoint and its picture (PNG); None: no body of the pair can be drawn."""
        pair = [self._bodies[m.id] for m in shown.members if m.id in self._bodies]
        if not pair:
            return None
        view = view_of(pair, len(pair) == 2, self._up, SIZE)
        near = replace(self._scene, bodies=tuple(self._near(view)))
        finding = shown.finding if len(pair) == 2 else None
        if finding is None:
            near = replace(near, bodies=tuple(pair))
        image = image_of(near, finding, pair, view, SIZE)
        camera = self._camera(view, pair)
        seen = bcf.VisualizationInfo(
            guid=shown.guid, components=_components(shown), orthogonal_camera=camera
        )
        return seen, image

    def _near(self, view: View) -> list[Body]:
        """The bodies that may be in the image."""
        reach = np.hypot(*SIZE) / 2 / view.scale
        low, high = self._boxes[:, 0], self._boxes[:, 1]
        near = ((low <= view.target + reach) & (high >= view.target - reach)).all(axis=1)
        return [self._scene.bodies[k] for k in np.flatnonzero(near)]

    def _camera(self, view: View, pair: Sequence[Body]) -> Any:
        """The eye stands before the bodies, so that no wall is between. Metres, z up."""
        _, up, towards = view.rows
        points = np.concatenate([np.asarray(body.world_mesh().bounds) for body in pair])
        height = SIZE[1] / view.scale
        corners = np.array(np.meshgrid(*zip(points.min(axis=0), points.max(axis=0), strict=True)))
        ahead = ((corners.reshape(3, -1).T - view.target) @ towards).max()
        eye = view.target + towards * (ahead + height)
        return bcf.OrthogonalCamera(
            camera_view_point=bcf.Point(**self._placed(eye * self._metres)),
            camera_direction=bcf.Direction(**self._placed(-towards)),
            camera_up_vector=bcf.Direction(**self._placed(up)),
            view_to_world_scale=float(height * self._metres),
            aspect_ratio=SIZE[0] / SIZE[1],
        )

    def _placed(self, vector: Floats) -> dict[str, float]:
        """In the axes of BCF."""
        return dict(zip("xyz", map(float, self._axes @ vector + 0.0), strict=True))


def _components(pair: Pair) -> Any:
    """Both bodies, selected and coloured."""
    both = [_component(member) for member in pair.members]
    colours = [
        bcf.ComponentColoringColor(
            color=colour, components=bcf.ComponentColoringColorComponents(component=[each])
        )
        for each, colour in zip(both, COLOURS, strict=True)
    ]
    hints = bcf.ViewSetupHints()  # no spaces, no openings
    return bcf.Components(
        selection=bcf.ComponentSelection(component=both),
        visibility=bcf.ComponentVisibility(view_setup_hints=hints, default_visibility=True),
        coloring=bcf.ComponentColoring(color=colours),
    )


def _component(member: Member) -> Any:
    """Programs find an element by its GlobalId only."""
    if member.guid is None:
        return bcf.Component(authoring_tool_id=member.id)
    return bcf.Component(ifc_guid=member.guid)
