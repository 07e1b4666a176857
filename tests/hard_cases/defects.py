"""Mesh files with every defect that the inspection knows, through `satcheck.audit.check`.

Each defect is a change of the unit cube whose right relation with four partners is known: one
apart, one that touches a face, one that crosses it, one inside. What is closed but for holes has an
inside away from them, whatever fills them; what is a sheet has none.
"""

from __future__ import annotations

import tempfile
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path

from satcheck.audit import Settings, check
from tests.hard_cases.score import Score
from tests.scene import files

CATEGORY = "mesh files with defects"

Points = list[tuple[float, float, float]]
Faces = list[tuple[int, ...]]
Maker = Callable[[Points, Faces], bytes]

CUBE: Points = [(float(x), float(y), float(z)) for x, y, z in files.CUBE_POINTS]
FACES: Faces = [(a, b, c) for a, b, c in files.CUBE]
BACKWARDS: Faces = [face[::-1] for face in FACES]
FORMATS: dict[str, Maker] = {
    "obj": files.obj,
    "stl": files.binary_stl,
    "ply": lambda points, faces: files.binary_ply(points, faces, double=True),
    "off": files.off,
}


def shifted(offset: tuple[float, float, float], points: Points = CUBE) -> Points:
    return [(x + offset[0], y + offset[1], z + offset[2]) for x, y, z in points]


def joined(*bodies: tuple[Points, Faces]) -> tuple[Points, Faces]:
    points: Points = []
    faces: Faces = []
    for body_points, body_faces in bodies:
        faces += [tuple(i + len(points) for i in face) for face in body_faces]
        points += body_points
    return points, faces


def one_sided() -> tuple[Points, Faces]:
    """A real projective plane of six vertices and ten triangles in a corner of the cube: closed,
    and no orientation fits it."""
    corners = [((1 + x) / 16, (1 + y) / 16, (1 + z) / 16) for x, y, z in [*CUBE[:5], CUBE[7]]]
    faces: Faces = [
        *((0, 1, 2), (0, 2, 3), (0, 3, 4), (0, 4, 5), (0, 5, 1)),
        *((1, 2, 4), (2, 3, 5), (3, 4, 1), (4, 5, 2), (5, 1, 3)),
    ]
    return joined((CUBE, FACES), (corners, faces))


def mid_edge() -> tuple[Points, Faces]:
    """An edge split on one side only, the gap filled by a triangle of area 0."""
    (p, q, r), *others = FACES
    middle = tuple((CUBE[p][i] + CUBE[q][i]) / 2 for i in range(3))
    split: Faces = [(p, 8, r), (8, q, r), (p, q, 8)]
    return [*CUBE, (middle[0], middle[1], middle[2])], [*split, *others]


# Points, faces, the codes that must be reported, whether a partner inside is inside.
DEFECTS: dict[str, tuple[Points, Faces, frozenset[str], bool]] = {
    "none": (CUBE, FACES, frozenset(), True),
    "unused vertices": ([*CUBE, (0.5, 0.5, 0.5)], FACES, frozenset(), True),
    "a corner twice": (
        [*CUBE, CUBE[0]],
        [tuple(8 if i == 0 else i for i in FACES[0]), *FACES[1:]],
        frozenset(),
        True,
    ),
    "a triangle missing": (CUBE, FACES[1:], frozenset({"not-closed"}), True),
    "no lid": (CUBE, FACES[:-2], frozenset({"not-closed"}), True),
    "a triangle turned": (CUBE, [FACES[0][::-1], *FACES[1:]], frozenset({"misoriented"}), True),
    "half of it turned": (CUBE, [*BACKWARDS[:6], *FACES[6:]], frozenset({"misoriented"}), True),
    "inside out": (CUBE, BACKWARDS, frozenset({"inside-out"}), True),
    "a part inside out": (
        *joined((CUBE, FACES), (shifted((8, 8, 8)), BACKWARDS)),
        frozenset({"inside-out"}),
        True,
    ),
    "two cubes at an edge": (
        *joined((CUBE, FACES), (shifted((0, -1, -1)), FACES)),
        frozenset({"not-manifold"}),
        True,
    ),
    "two cubes at a corner": (
        *joined((CUBE, FACES), (shifted((-1, -1, -1)), FACES)),
        frozenset(),
        True,
    ),
    "double-sided": (CUBE, FACES + BACKWARDS, frozenset({"double-sided"}), False),
    "a triangle of area 0": (*mid_edge(), frozenset({"degenerate-triangles"}), True),
    "triangles of one corner": (
        CUBE,
        [*FACES, (3, 3, 3), (1, 1, 2)],
        frozenset({"degenerate-triangles"}),
        True,
    ),
    "a triangle twice": (CUBE, [*FACES, FACES[3]], frozenset({"duplicate-triangles"}), True),
    "a one-sided part": (*one_sided(), frozenset({"misoriented", "not-closed"}), True),
    "a sheet": (
        [(1.0, -9.0, -9.0), (1.0, 9.0, -9.0), (1.0, 0.0, 9.0)],
        [(0, 1, 2)],
        frozenset({"not-closed", "flat"}),
        False,
    ),
    "each triangle twice": (CUBE, FACES * 2, frozenset({"duplicate-triangles"}), True),
}
# x of the partner, a cube of half the size in the middle of the unit cube's height, and the
# relation with a solid.
PARTNERS = {
    "apart": (1.25, "separated"),
    "touching": (1.0, "touching"),
    "crossing": (0.75, "penetrating"),
    "inside": (0.25, "contains"),
}
REFUSED: dict[str, tuple[bytes, str]] = {
    "no triangles": (files.obj(CUBE, []), "empty-mesh"),
    "only triangles of area 0": (files.obj(CUBE, [(0, 0, 1), (0, 1, 1)]), "only-degenerate"),
    "not a number": (files.obj([(float("nan"), 0, 0), *CUBE[1:]]), "non-finite"),
    "infinite": (files.obj([(float("inf"), 0, 0), *CUBE[1:]]), "non-finite"),
    "too large": (files.obj([(1e300, 0, 0), *CUBE[1:]]), "out-of-range"),
    "too small": (
        files.obj([(x * 1e-300, y * 1e-300, z * 1e-300) for x, y, z in CUBE]),
        "out-of-range",
    ),
    "a face too many": (files.obj(CUBE, [*FACES, (0, 1, 8)]), "index-out-of-range"),
    "cut short": (files.binary_stl()[:-7], "truncated"),
}


@dataclass(frozen=True, slots=True)
class DefectPair:
    """Two files: names and bytes. relation: None where the first is to be refused. codes: reported
    of the first."""

    name: str
    files: tuple[tuple[str, bytes], tuple[str, bytes]]
    relation: str | None
    codes: frozenset[str]


def cases() -> Iterator[DefectPair]:
    for defect, (points, faces, codes, solid) in DEFECTS.items():
        for suffix, write in FORMATS.items():
            for partner, (x, relation) in PARTNERS.items():
                half = [(x + a / 2, 0.25 + b / 2, 0.25 + c / 2) for a, b, c in CUBE]
                free = relation == "contains" and not solid
                yield DefectPair(
                    f"{defect}, {suffix}, {partner}",
                    ((f"a.{suffix}", write(points, faces)), ("b.obj", files.obj(half, FACES))),
                    "separated" if free else relation,
                    codes,
                )
    for name, (content, code) in REFUSED.items():
        first = "a.stl" if code == "truncated" else "a.obj"
        yield DefectPair(name, ((first, content), ("b.obj", files.obj())), None, frozenset({code}))


def judge_defects(score: Score) -> None:
    settings = Settings(depth=False, list_pruned=True)
    with tempfile.TemporaryDirectory() as folder:
        for pair in cases():
            score.cases += 1
            score.answers += 1
            paths = []
            for name, content in pair.files:
                (Path(folder) / name).write_bytes(content)
                paths.append(Path(folder) / name)
            report = check(paths, settings)
            (finding,) = report.findings
            codes = {issue.code for issue in report.issues if issue.body != "b"}
            if finding.relation != (pair.relation or "indeterminate"):
                score.fail("wrong", f"{pair.name}: {finding.relation}, in truth {pair.relation}")
            if not pair.codes <= codes:
                score.fail("wrong", f"{pair.name}: {sorted(codes)}, not {sorted(pair.codes)}")
            if pair.relation and finding.quality != "exact":
                score.fail("wrong", f"{pair.name}: {finding.quality}")
