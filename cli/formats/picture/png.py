"""The worst finding as an image, PNG: drawn without a GPU or a window.

A is blue, B orange, both translucent, and what they share red, with the way out or the gap, the
ball of the thickness, labels and a caption. Where other bodies are beyond the view, all of them are
beside it, with a ring around what is seen. Bodies that hit while they move stand as they do then.
Without a finding: all bodies, those that fail in red, with contact forces in green, and how bodies
that fall start to move in black.
"""

from __future__ import annotations

import struct
import zlib
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from satcheck.audit.words import is_hit, short_names
from satcheck.cli.formats.picture import drawn_finding, headline, require_drawable, up_of
from satcheck.cli.formats.picture.body_answers import arrows_of, states_of, without_regions
from satcheck.cli.formats.picture.lettering import width_of, write
from satcheck.cli.formats.picture.marks import arrow, ball_of, dot, rod
from satcheck.cli.formats.picture.moments import moments_of, sphere_around
from satcheck.cli.formats.picture.raster import INNER, MARKS, Kind, Triangles, drawn
from satcheck.cli.formats.picture.shown import Shows, placed_point
from satcheck.cli.formats.picture.viewpoint import Viewpoint, of_all
from satcheck.report.colliders import OF_COLLIDERS
from satcheck.report.report import OVERLAPS
from satcheck.report.verdict import severity

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Sequence

    import numpy.typing as npt

    from satcheck.cli.formats.picture.moments import Moments
    from satcheck.cli.formats.picture.raster import Colour
    from satcheck.cli.formats.picture.shown import Shown
    from satcheck.core import Mesh
    from satcheck.report.report import Report
    from satcheck.scene import Body, Scene

    Floats = npt.NDArray[np.float64]
    Pixels = npt.NDArray[np.uint8]

SIZE = (1200, 900)
WHITE = (1.0, 1.0, 1.0)
A, B, OTHER, ALONE, ARROW, BALL, CURVE, FORCE, FAILS, RIM, SHARED = range(11)
RED, GREEN, BLACK = (0.86, 0.1, 0.12), (0.0, 0.6, 0.45), (0.0, 0.0, 0.0)
KINDS = [
    Kind((0.16, 0.44, 0.84), 0.4),
    Kind((0.9, 0.55, 0.1), 0.4),
    Kind((0.5, 0.54, 0.6), 0.08),
    Kind((0.5, 0.54, 0.6), 1.0),
    Kind(BLACK, 1.0, MARKS),
    Kind((1.0, 0.85, 0.1), 0.8, MARKS),
    Kind(RED, 1.0, MARKS),
    Kind(GREEN, 1.0, MARKS),
    Kind((0.82, 0.2, 0.2), 1.0),
    Kind((0.75, 0.1, 0.65), 1.0, MARKS),
    Kind(RED, 0.85, INNER),
]
# Which body is all of the overlap, as on the page.
_INNER = {"contains": 1, "inside": 0, "coincident": 0}
CROWD, FAINT = 100, 0.025  # of so many bodies each is as faint
OVERLAP = Kind(RED, 0.9)
MARGIN = 1.1
# A scene that reaches so many radii of the view has a strip beside it, of this share of the width,
# in which bodies but the pair have this alpha; and the ring: its points, its least radius.
_CLOSE, _STRIP, _ASIDE, _RING, _LEAST_RING = 1.6, 0.25, 0.3, 65, 0.06
LINE, THICK = 1.0, 2.0  # half the width of a line in pixels, and of the rim of a hole
# The colours of labels.
_LABELS = {"a": A, "b": B, "arrow": ARROW, "gap": FORCE, "ball": BALL, "hit": CURVE, "hole": RIM}
INK, BAND = (0.11, 0.13, 0.16), (0.96, 0.965, 0.97)
_LETTER, _LEAST_LETTER = 0.0155, 7.5  # a capital letter, of the height of the image, and in pixels
_ROW, _PAD = 2.2, 0.7  # of a line of letters, and around it, in heights of a letter


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


def render(
    report: Report,
    scene: Scene,
    size: tuple[int, int] = SIZE,
    moments: Moments | None = None,
) -> bytes:
    """size: width and height in pixels, the caption included. moments: None: those of motions."""
    scene = without_regions(scene)
    require_drawable(scene)
    up, letter = up_of(scene), _letter(size)
    moments = moments or moments_of(report, scene)
    finding = drawn_finding(report, scene)
    lines = 1 if finding is None else 2
    room = size[0], size[1] - round((lines * _ROW + 2 * _PAD) * letter)
    if finding is None:
        view = view_of(of_all(scene.bodies, up), list(scene.bodies), up, room)
        image = _image(_answers(report, scene), [], KINDS, view, room)
        return image_file(_captioned(image, [[(None, headline(report, moments))]], size))
    shows = Shows(report, scene, moments, up)
    shown = shows.of(finding)
    bodies = shows.scene_at(shown.moment).bodies
    aside = None
    if sphere_around(bodies)[1] > _CLOSE * shown.view.radius:
        # A picture of the pair does not tell where in the scene it is.
        aside = _beside(bodies, shown, up, room)
        room = room[0] - aside.shape[1], room[1]
    view = view_of(shown.view, shown.pair, up, room, shown.marks.points())
    image = image_of(bodies, shown, view, room)
    image = image if aside is None else np.concatenate([image, aside], axis=1)
    a, b = short_names(finding.a, finding.b)
    said = [moments.note] if moments.note else []
    says_it = finding.rule in OF_COLLIDERS or (is_hit(finding) and shown.marks.hit is not None)
    said += [] if says_it else [finding.at_rest]
    said += [label.text for label in shown.labels if label.kind not in ("a", "b")]
    words = f"{severity(finding)}: {', '.join(said)}"
    return image_file(_captioned(image, [[(A, a), (B, b)], [(None, words)]], size))


def _beside(bodies: Sequence[Body], shown: Shown, up: str, size: tuple[int, int]) -> Pixels:
    """Return all bodies from the same side, for a strip of an image of this size: the pair solid,
    the others faint, and a ring around what the view shows."""
    kinds = [kind._replace(alpha=1.0) for kind in KINDS]
    kinds[OTHER] = kinds[OTHER]._replace(alpha=_ASIDE)
    numbers = {shown.finding.a: A, shown.finding.b: B}
    centre, radius = sphere_around(bodies)
    seen, strip = shown.view._replace(target=centre, radius=radius), round(_STRIP * size[0])
    turn = np.linspace(0.0, 2.0 * np.pi, _RING)
    right, above, _ = seen.rows(up)
    reach = max(shown.view.radius, _LEAST_RING * radius)
    ring = shown.view.target + reach * (
        np.outer(np.cos(turn), right) + np.outer(np.sin(turn), above)
    )
    view = view_of(seen, list(bodies), up, (strip, size[1]), ring)
    meshes = ((body.world_mesh(), numbers.get(body.id, OTHER)) for body in bodies)
    return _image(meshes, [(ring, CURVE)], kinds, view, (strip, size[1]), ground=BAND)


def image_of(bodies: Sequence[Body], shown: Shown, view: View, size: tuple[int, int]) -> Pixels:
    """The pair with its marks and labels. bodies: of the scene, as they stand then."""
    kinds, finding = list(KINDS), shown.finding
    if len(bodies) > CROWD:
        kinds[OTHER] = kinds[OTHER]._replace(alpha=FAINT)
    lines = [(line, CURVE) for line in shown.marks.lines]
    lines += [(line, RIM) for line in (shown.marks.rim.lines if shown.marks.rim else [])]
    overlap = OVERLAP if finding.at_rest in OVERLAPS else None
    image = _image(_meshes(bodies, shown), lines, kinds, view, size, overlap)
    _label(image, shown, view)
    return image


def image_of_bodies(bodies: Iterable[Body], view: View, size: tuple[int, int]) -> Pixels:
    return _image(((body.world_mesh(), ALONE) for body in bodies), [], KINDS, view, size)


def _image(
    meshes: Iterable[tuple[Mesh, int]],
    lines: Iterable[tuple[Floats, int]],
    kinds: list[Kind],
    view: View,
    size: tuple[int, int],
    overlap: Kind | None = None,
    ground: Colour = WHITE,
) -> Pixels:
    """meshes, lines: in the world, with their kinds. overlap: of what A and B have in common."""
    corners, numbers = [np.empty((0, 3, 3))], [np.empty(0, dtype=np.int64)]
    for mesh, kind in meshes:
        faces = view.seen(np.asarray(mesh.vertices))[np.asarray(mesh.triangles)]
        corners.append(faces)
        numbers.append(np.full(len(faces), kind))
    for line, kind in lines:
        quads = _quads(view.seen(np.array(line)), THICK if kind == RIM else LINE)
        corners.append(quads)
        numbers.append(np.full(len(quads), kind))
    triangles = Triangles(np.concatenate(corners), np.concatenate(numbers))
    return drawn(triangles, kinds, overlap, size, ground)


def _letter(size: tuple[int, int]) -> float:
    return max(_LETTER * size[1], _LEAST_LETTER)


def _captioned(
    image: Pixels, lines: list[list[tuple[int | None, str]]], size: tuple[int, int]
) -> Pixels:
    """Lines of words below an image. Each word may have the colour of a kind before it."""
    letter, (width, height) = _letter(size), size
    longest = max(sum(width_of(text, 1.0) + 3.7 for _, text in words) for words in lines)
    letter = min(letter, width / longest)
    band = np.empty((height - len(image), width, 3), np.uint8)
    band[:] = np.array(BAND) * 255.0
    for row, words in enumerate(lines):
        left, base = _PAD * letter, (_PAD + row * _ROW + 1.6) * letter
        for kind, text in words:
            if kind is not None:
                _fill(band, left, base - letter, letter, letter, KINDS[kind].colour, 1.0)
                left += 1.7 * letter
            write(band, text, left, base, letter, INK)
            left += width_of(text, letter) + 2.0 * letter
    return np.concatenate([image, band])


def _label(image: Pixels, shown: Shown, view: View) -> None:
    """Each label beside its point, or in the nearest free row below or above it. Letters are so
    small that the longest label has room."""
    height, width = image.shape[:2]
    longest = max((width_of(label.text, 1.0) + 1.6 for label in shown.labels), default=1.0)
    letter = min(0.85 * _letter((width, height)), width / longest)
    taken: list[tuple[float, float, float]] = []
    high = 2.0 * letter
    for text, at, kind in shown.labels:
        point = at
        if kind in ("a", "b"):
            point = np.asarray(placed_point(shown.pair["ab".index(kind)], at))
        x, y, _ = view.seen(point)
        wide = width_of(text, letter) + 1.6 * letter
        left = min(max(x + letter, 0.0), width - wide)
        first = min(max(y - 1.5 * high, 0.0), height - high)
        tops = [row for low, end, row in taken if left < end and low < left + wide]
        rows = [first, *(row + step for step in (1.05 * high, -1.05 * high) for row in tops)]
        free = (
            row
            for row in sorted(rows, key=lambda row: abs(row - first))
            if 0.0 <= row <= height - high and all(abs(row - other) >= high for other in tops)
        )
        top = next(free, first)
        taken.append((left, left + wide, top))
        _fill(image, left, top, wide, high, BAND, 0.85)
        _fill(image, left, top, 0.4 * letter, high, KINDS[_LABELS[kind]].colour, 1.0)
        write(image, text, left + letter, top + 1.5 * letter, letter, INK)


def _fill(
    image: Pixels, left: float, top: float, wide: float, high: float, colour: Colour, share: float
) -> None:
    """share: of the colour in what is there."""
    area = image[max(round(top), 0) : round(top + high), max(round(left), 0) : round(left + wide)]
    area[:] = (area * (1.0 - share) + np.array(colour) * 255.0 * share + 0.5).astype(np.uint8)


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


def view_of(
    seen_from: Viewpoint,
    pair: list[Body],
    up: str,
    size: tuple[int, int],
    also: Iterable[Floats] = (),
) -> View:
    """Fits the bodies into the image, or what is to be seen of them. also: further points."""
    rows, radius = seen_from.rows(up), seen_from.radius
    if radius < sphere_around(pair)[1]:
        points = [seen_from.target + radius * np.concatenate([np.eye(3), -np.eye(3)])]
    else:
        points = [np.asarray(body.world_mesh().vertices) for body in pair]
    every = [*points, *(point[None] for point in also)] or [np.zeros((1, 3))]
    seen = np.concatenate(every) @ rows.T
    low, high = seen.min(axis=0), seen.max(axis=0)
    largest = max((high - low)[:2] / size) or 1.0
    middle = (size[0] / 2, size[1] / 2)
    return View(rows, (low + high) / 2 @ rows, 1.0 / (MARGIN * largest), middle)


def _meshes(bodies: Iterable[Body], shown: Shown) -> Iterator[tuple[Mesh, int]]:
    """In the world, with their kinds."""
    finding, marks = shown.finding, shown.marks
    kinds = {finding.a: A, finding.b: B}
    if finding.at_rest in _INNER:
        kinds[(finding.a, finding.b)[_INNER[finding.at_rest]]] = SHARED
    for body in bodies:
        yield body.world_mesh(), kinds.get(body.id, OTHER)
    radius = sphere_around(shown.pair)[1]
    beside = min(radius, shown.view.radius)
    if marks.way is not None:
        yield arrow(*marks.way, radius), ARROW
    if marks.gap is not None and (marks.gap[0] != marks.gap[1]).any():
        yield rod(*marks.gap, beside), FORCE
        yield from ((dot(point, beside / 2), FORCE) for point in marks.gap)
    if marks.hit is not None:
        yield dot(marks.hit, beside), CURVE
    if (ball := ball_of(finding)) is not None:
        yield ball, BALL


def _answers(report: Report, scene: Scene) -> Iterator[tuple[Mesh, int]]:
    """All bodies, those that fail in red, contact forces, and how bodies that fall start to
    move."""
    radius = sphere_around(scene.bodies)[1]
    states = states_of(report)
    for body in scene.bodies:
        yield body.world_mesh(), FAILS if states.get(body.id) == "error" else ALONE
    for start, way, kind in arrows_of(report, scene):
        yield arrow(start, way, radius), FORCE if kind == "force" else ARROW


def _quads(line: Floats, half: float) -> Floats:
    """Two triangles for each piece of a line that is seen, (n, 3, 3)."""
    start, end = line[:-1], line[1:]
    along = (end - start)[:, :2]
    length = np.linalg.norm(along, axis=1, keepdims=True)
    side = np.zeros_like(start)
    side[:, :2] = along[:, ::-1] * [-half, half] / np.where(length > 0.0, length, 1.0)
    a, b, c, d = start - side, end - side, end + side, start + side
    return np.concatenate([np.stack([a, b, c], axis=1), np.stack([a, c, d], axis=1)])
