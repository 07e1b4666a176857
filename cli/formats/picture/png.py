"""The worst finding as an image, PNG: drawn without a GPU or a window.

A is blue, B orange, both translucent, and what they share red, with the way out and the ball of the
thickness. Without a finding: all bodies, those that fail in red, with contact forces in green, and
how bodies that fall start to move in black.
"""

from __future__ import annotations

import struct
import zlib
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from satcheck.cli.formats.picture.body_answers import arrows_of, states_of, without_regions
from satcheck.cli.formats.picture.data import drawn_finding, lines_of, require_drawable, up_of
from satcheck.cli.formats.picture.marks import arrow, arrow_of, ball_of, sphere_around
from satcheck.cli.formats.picture.raster import Kind, Triangles, drawn

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator

    import numpy.typing as npt

    from satcheck.core import Mesh
    from satcheck.report.report import Finding, Report
    from satcheck.scene import Body, Scene

    Floats = npt.NDArray[np.float64]

SIZE = (1200, 900)
WHITE = (1.0, 1.0, 1.0)
A, B, OTHER, ALONE, ARROW, BALL, CURVE, FORCE, FAILS = range(9)
KINDS = [
    Kind((0.16, 0.44, 0.84), 0.4),
    Kind((0.9, 0.55, 0.1), 0.4),
    Kind((0.5, 0.54, 0.6), 0.08),
    Kind((0.5, 0.54, 0.6), 1.0),
    Kind((0.0, 0.0, 0.0), 1.0, in_front=True),
    Kind((1.0, 0.85, 0.1), 0.8, in_front=True),
    Kind((0.86, 0.1, 0.12), 1.0, in_front=True),
    Kind((0.0, 0.6, 0.45), 1.0, in_front=True),
    Kind((0.82, 0.2, 0.2), 1.0),
]
CROWD, FAINT = 100, 0.025  # of so many bodies each is as faint
OVERLAP = Kind((0.86, 0.1, 0.12), 0.9)
YAW, PITCH = -0.7, 0.5  # of the page, too
MARGIN = 1.1
LINE = 1.0  # half the width of a line in pixels


class View(NamedTuple):
    """A parallel projection. rows: right, up, and towards the eye. target: a point in the middle of
    the image. scale: pixels of a unit of length. middle: of the image, in pixels."""

    rows: Floats
    target: Floats
    scale: float
    middle: tuple[float, float]

    def seen(self, points: Floats) -> Floats:
        """(..., 3): right and down in pixels, away from the eye."""
        placed = (points - self.target) @ self.rows.T * self.scale
        return placed * [1.0, -1.0, -1.0] + [*self.middle, 0.0]


def render(report: Report, scene: Scene, size: tuple[int, int] = SIZE) -> bytes:
    """size: width and height in pixels."""
    scene = without_regions(scene)
    require_drawable(scene)
    bodies = {body.id: body for body in scene.bodies}
    finding = drawn_finding(report, scene)
    pair = [bodies[finding.a], bodies[finding.b]] if finding else list(bodies.values())
    view = view_of(pair, bool(finding), up_of(scene), size)
    if finding:
        return image_of(scene, finding, pair, view, size)
    return _image(_answers(report, scene), [], KINDS, view, size)


def image_of(
    scene: Scene, finding: Finding | None, pair: list[Body], view: View, size: tuple[int, int]
) -> bytes:
    """pair: the bodies of the finding."""
    kinds = list(KINDS)
    if len(scene.bodies) > CROWD:
        kinds[OTHER] = kinds[OTHER]._replace(alpha=FAINT)
    lines = lines_of(finding) if finding else []
    return _image(_meshes(scene, finding, pair), lines, kinds, view, size)


def _image(
    meshes: Iterable[tuple[Mesh, int]],
    lines: Iterable[list[tuple[float, float, float]]],
    kinds: list[Kind],
    view: View,
    size: tuple[int, int],
) -> bytes:
    """meshes: in the world, with their kinds."""
    corners, numbers = [np.empty((0, 3, 3))], [np.empty(0, dtype=np.int64)]
    for mesh, kind in meshes:
        faces = view.seen(np.asarray(mesh.vertices))[np.asarray(mesh.triangles)]
        corners.append(faces)
        numbers.append(np.full(len(faces), kind))
    for line in lines:
        quads = _quads(view.seen(np.array(line)))
        corners.append(quads)
        numbers.append(np.full(len(quads), CURVE))
    triangles = Triangles(np.concatenate(corners), np.concatenate(numbers))
    return image_file(drawn(triangles, kinds, OVERLAP, size, WHITE))


def image_file(pixels: npt.NDArray[np.uint8]) -> bytes:
    """PNG (ISO/IEC 15948) of (height, width, 3): 8 bits a channel, each row as differences to the
    one above."""
    height, width, _ = pixels.shape
    rows = np.diff(pixels.reshape(height, -1), axis=0, prepend=np.zeros((1, 3 * width), np.uint8))
    filtered = np.column_stack([np.full((height, 1), 2, np.uint8), rows])
    header = struct.pack(">IIBBBBB", width, height, 8, 2, 0, 0, 0)
    chunks = {b"IHDR": header, b"IDAT": zlib.compress(filtered.tobytes(), 9), b"IEND": b""}
    return b"\x89PNG\r\n\x1a\n" + b"".join(
        struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))
        for kind, data in chunks.items()
    )


def view_of(bodies: list[Body], is_pair: bool, up: str, size: tuple[int, int]) -> View:
    """Fits the bodies into the image."""
    towards = np.array([np.cos(PITCH) * np.cos(YAW), np.cos(PITCH) * np.sin(YAW), np.sin(PITCH)])
    right = np.array([-np.sin(YAW), np.cos(YAW), 0.0])
    rows = np.stack([right, np.cross(towards, right), towards])
    rows = np.roll(rows, -1, axis=1) if up == "y" else rows
    seen = _to_be_seen(bodies, is_pair) @ rows.T
    low, high = seen.min(axis=0), seen.max(axis=0)
    largest = max((high - low)[:2] / size) or 1.0
    middle = (size[0] / 2, size[1] / 2)
    return View(rows, (low + high) / 2 @ rows, 1.0 / (MARGIN * largest), middle)


def _to_be_seen(bodies: list[Body], is_pair: bool) -> Floats:
    """Points, (n, 3), at least one."""
    if is_pair:
        # Beside a large body the small one says where to look.
        least, size = min((sphere_around([body]) for body in bodies), key=lambda each: each[1])
        if 4.0 * size < sphere_around(bodies)[1]:
            return least + 2.0 * size * np.concatenate([np.eye(3), -np.eye(3)])
    points = [np.asarray(body.world_mesh().vertices) for body in bodies]
    return np.concatenate(points) if points else np.zeros((1, 3))


def _meshes(scene: Scene, finding: Finding | None, pair: list[Body]) -> Iterator[tuple[Mesh, int]]:
    """In the world, with their kinds."""
    if finding is None:
        yield from ((body.world_mesh(), ALONE) for body in scene.bodies)
        return
    kinds = {finding.a: A, finding.b: B}
    for body in scene.bodies:
        yield body.world_mesh(), kinds.get(body.id, OTHER)
    for mark, kind in ((arrow_of(finding, *sphere_around(pair)), ARROW), (ball_of(finding), BALL)):
        if mark is not None:
            yield mark, kind


def _answers(report: Report, scene: Scene) -> Iterator[tuple[Mesh, int]]:
    """All bodies, those that fail in red, contact forces, and how bodies that fall start to
    move."""
    radius = sphere_around(list(scene.bodies))[1]
    states = states_of(report)
    for body in scene.bodies:
        yield body.world_mesh(), FAILS if states.get(body.id) == "error" else ALONE
    for start, way, kind in arrows_of(report, scene):
        yield arrow(start, way, radius), FORCE if kind == "force" else ARROW


def _quads(line: Floats) -> Floats:
    """Two triangles for each piece of a line that is seen, (n, 3, 3)."""
    start, end = line[:-1], line[1:]
    along = (end - start)[:, :2]
    length = np.linalg.norm(along, axis=1, keepdims=True)
    side = np.zeros_like(start)
    side[:, :2] = along[:, ::-1] * [-LINE, LINE] / np.where(length > 0.0, length, 1.0)
    a, b, c, d = start - side, end - side, end + side, start + side
    return np.concatenate([np.stack([a, b, c], axis=1), np.stack([a, c, d], axis=1)])
