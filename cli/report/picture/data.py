"""What the page shows, as JSON values: findings, the worst first, and the geometry of bodies.

Geometry is for the eye only: 16 bits for a coordinate within the box of its mesh, deflated. Beyond
MOST_TRIANGLES bodies without findings are boxes.
"""

from __future__ import annotations

import base64
import zlib
from typing import TYPE_CHECKING, Any

import numpy as np
from msgspec import to_builtins

from satcheck.cli.report.ci.problems import sentence
from satcheck.cli.report.summary import summary_line
from satcheck.cli.report.words import issue_line
from satcheck.report.report import SEVERITIES
from satcheck.scene.units import unit_of

if TYPE_CHECKING:
    from collections.abc import Sequence

    import numpy.typing as npt

    from satcheck.core import Mesh
    from satcheck.report.report import Finding, Report
    from satcheck.scene import Scene
    from satcheck.scene.bodies import Body

    Floats = npt.NDArray[np.float64]

MOST_TRIANGLES = 300_000
LARGEST = 1e18  # a coordinate whose square the renderer can hold: it has float32
STEPS = 65535  # of a coordinate, from one side of the box to the other


def picture_data(report: Report, scene: Scene) -> dict[str, Any]:
    """Lengths in units of the scene, relative to the middle of all bodies. A body that cannot be
    drawn has no number."""
    bodies = list(scene.bodies) if _can_be_drawn(scene) else []
    met = {id_ for finding in report.findings if _is_listed(finding) for id_ in _ids(finding)}
    simple = sum(body.file.mesh.triangle_count for body in bodies) > MOST_TRIANGLES
    boxes = [np.array(body.world_mesh().bounds) for body in bodies]
    corners = np.array(boxes) if boxes else np.zeros((1, 2, 3))
    middle = (corners[:, 0].min(axis=0) + corners[:, 1].max(axis=0)) / 2
    meshes = _Meshes(middle)
    numbers = {body.id: number for number, body in enumerate(bodies)}
    findings = sorted(filter(_is_listed, report.findings), key=_rank)
    return {
        "title": summary_line(report),
        "verdict": report.summary.verdict,
        "simplified": simple,
        "bodies": [
            {
                "id": body.id,
                "low": _short(box[0] - middle),
                "size": _short(box[1] - box[0]),
                **(meshes.box(box) if simple and body.id not in met else meshes.body(body)),
                "hull": meshes.hull(body) if body.id in met else None,
            }
            for body, box in zip(bodies, boxes, strict=True)
        ],
        "meshes": meshes.packed,
        "findings": [
            _shown(finding, numbers, middle, unit_of(report.units)) for finding in findings
        ],
        "issues": [issue_line(issue) for issue in report.issues],
        "drawn": len(bodies) == len(scene.bodies),
    }


def _can_be_drawn(scene: Scene) -> bool:
    try:
        bounds = [body.world_mesh().bounds for body in scene.bodies]
    except OverflowError:
        return False
    return bool(np.abs(np.array(bounds)).max(initial=0.0) < LARGEST)


class _Meshes:
    """Packed meshes, each once; a body is the number of one, and its frame: the rows of the 3 x 4
    matrix from the box of the mesh, whose sides are 1, into the scene. middle: of the scene."""

    def __init__(self, middle: Floats) -> None:
        self.packed: list[dict[str, Any]] = []
        self._middle = middle
        self._numbers: dict[str, int] = {}
        self._frames: dict[tuple[str, int], tuple[int, Floats]] = {}

    def body(self, body: Body) -> dict[str, Any]:
        return self._placed(("mesh", id(body.file.mesh)), body.file.mesh, body.transform)

    def hull(self, body: Body) -> dict[str, Any] | None:
        """None where it has no volume."""
        hull = body.file.mesh.convex_hull()
        if hull.dimension < 3:
            return None
        return self._placed(("hull", id(body.file.mesh)), hull.to_mesh(), body.transform)

    def box(self, corners: Floats) -> dict[str, Any]:
        low, size = corners[0], corners[1] - corners[0]
        matrix = np.diag([*size, 1.0])
        matrix[:3, 3] = low
        return self._placed(("box", 0), cube(), tuple(matrix.ravel()))

    def _placed(
        self, key: tuple[str, int], mesh: Mesh, transform: Sequence[float] | None
    ) -> dict[str, Any]:
        if key not in self._frames:
            packed = _packed(mesh)
            number = self._numbers.setdefault(packed["data"], len(self.packed))
            self.packed += [packed] * (number == len(self.packed))
            self._frames[key] = number, _frame(mesh)
        number, frame = self._frames[key]
        if transform is not None:
            frame = np.array(transform).reshape(4, 4) @ frame
        rows = frame[:3].copy()
        rows[:, 3] -= self._middle
        return {"mesh": number, "frame": _short(rows)}


def _is_listed(finding: Finding) -> bool:
    return finding.severity != "none" or finding.undecided is not None


def _ids(finding: Finding) -> tuple[str, str]:
    return finding.a, finding.b


def _rank(finding: Finding) -> tuple[int, float]:
    return SEVERITIES.index(finding.severity), -(finding.depth or 0.0)


def cube() -> Mesh:
    """From 0 to 1."""
    from satcheck.core import Mesh

    corners = [[x, y, z] for x in (0, 1) for y in (0, 1) for z in (0, 1)]
    faces = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
    triangles = [t for a, b, c, d in faces for t in ((a, b, c), (a, c, d))]
    return Mesh(np.array(corners, dtype=np.float64), np.array(triangles, dtype=np.uint32))


def _frame(mesh: Mesh) -> Floats:
    """4 x 4: from the box of the mesh, whose sides are 1, into its coordinates."""
    low, high = np.array(mesh.bounds)
    matrix: Floats = np.diag([*(high - low), 1.0])
    matrix[:3, 3] = low
    return matrix


def _packed(mesh: Mesh) -> dict[str, Any]:
    """base64 of deflated little-endian uint16 coordinates in the box of the mesh, and of uint32
    indices behind them."""
    low, high = np.array(mesh.bounds)
    size = np.where(high > low, high - low, 1.0)
    steps = np.rint((np.asarray(mesh.vertices) - low) / size * STEPS).astype("<u2")
    indices = np.asarray(mesh.triangles).astype("<u4")
    raw = steps.tobytes() + b"\0" * (-steps.nbytes % indices.itemsize) + indices.tobytes()
    return {
        "vertices": mesh.vertex_count,
        "triangles": mesh.triangle_count,
        "data": base64.b64encode(zlib.compress(raw, 9)).decode(),
    }


def _shown(
    finding: Finding, numbers: dict[str, int], middle: Floats, unit: str | None
) -> dict[str, Any]:
    contacts = finding.contacts
    lines = [] if contacts is None else [curve.points for curve in contacts.curves]
    witness = None if finding.witness is None else to_builtins(finding.witness)
    return {
        "names": f"{finding.a} and {finding.b}",
        "a": numbers.get(finding.a),
        "b": numbers.get(finding.b),
        "relation": finding.relation,
        "severity": finding.severity,
        "text": sentence(finding, unit),
        "mtv": finding.mtv,
        "witness": witness and [_relative(witness[body], middle) for body in ("a", "b")],
        "curves": [[_relative(point, middle) for point in line] for line in lines],
    }


def _relative(point: Any, middle: Floats) -> list[float]:
    return _short(np.array(point) - middle)


def _short(values: Floats) -> list[float]:
    """As many digits as a float32 of the renderer holds."""
    return [float(f"{value:.8g}") for value in values.ravel()]
