"""The families of variants: the pair placed elsewhere, or its solids stored in another way."""

from __future__ import annotations

import math
import zlib
from collections.abc import Callable, Iterator
from itertools import permutations, product

import numpy as np
from numpy.random import Generator

from satcheck.core import Mesh
from satcheck.core.conventions import Vector
from satcheck.core.transform import quaternion_matrix
from satcheck.scene import Body, MeshFile
from satcheck.scene.shape_file import remeshed
from satcheck.studies.stability.retessellation import retessellate
from satcheck.studies.stability.variant import (
    Family,
    Points,
    Question,
    Rows,
    Variant,
    body,
    one_ulp,
    rounded_once,
    stretch,
)

# Powers of two up to this, either way, as far as the coordinates stay within the numeric range.
MOST_EXPONENT = 40
LARGEST_EXPONENT, SMALLEST_EXPONENT, SMALLEST_SIZE_EXPONENT = 149, -265, -149
ROOM_EXPONENTS = 4

# How far down from the size of the pair a translation is looked for that adds without rounding.
TRANSLATION_EXPONENTS = 48

# Edges split and diagonals turned in each mesh of a sample.
STEPS = 12


def scaled(question: Question, samples: int, rng: Generator) -> Iterator[Variant]:
    """By powers of two, which round nothing: the same answer, bit for bit."""
    exponents = _exponents(question)
    count = min(samples, len(exponents))
    for k in sorted(rng.choice(exponents, count, replace=False).tolist()) if count else ():
        factor = math.ldexp(1.0, k)
        turn = ((factor, 0.0, 0.0), (0.0, factor, 0.0), (0.0, 0.0, factor))
        yield Variant(
            "scale",
            f"times 2^{k}",
            body("a", question.a, turn),
            body("b", question.b, turn),
            scale=factor,
            identical=True,
        )


def _exponents(question: Question) -> list[int]:
    """Those that keep both within the coordinates that the core takes, with room for a way out."""
    coordinates = np.abs(question.points)
    edges = [np.ptp(file.mesh.vertices, axis=0).max() for file in question.files]
    smallest, largest, least = (
        math.frexp(float(length))[1]
        for length in (coordinates[coordinates > 0].min(), coordinates.max(), min(edges))
    )
    first = max(SMALLEST_EXPONENT - smallest, SMALLEST_SIZE_EXPONENT - least) + 1
    last = LARGEST_EXPONENT - largest - ROOM_EXPONENTS
    return [k for k in range(-MOST_EXPONENT, MOST_EXPONENT + 1) if k and first <= k < last]


def reaxed(question: Question, samples: int, rng: Generator) -> Iterator[Variant]:
    """Axes exchanged and turned round, mirror images among them: the coordinates stay the same
    numbers, but sums are taken in another order."""
    ways = [
        tuple(zip(order, signs, strict=True))
        for order in permutations(range(3))
        for signs in product((1.0, -1.0), repeat=3)
    ]
    for way in rng.choice(len(ways) - 1, min(samples, len(ways) - 1), replace=False).tolist():
        chosen = ways[1 + way]  # the first is no change at all
        x, y, z = (_row(axis, sign) for axis, sign in chosen)
        turn = (x, y, z)
        names = " ".join(("-" if sign < 0 else "") + "xyz"[axis] for axis, sign in chosen)
        yield Variant(
            "axes",
            f"({names}) for (x y z)",
            body("a", question.a, turn),
            body("b", question.b, turn),
            turn=turn,
        )


def _row(axis: int, sign: float) -> Vector:
    return sign * (axis == 0), sign * (axis == 1), sign * (axis == 2)


def swapped(question: Question, samples: int, rng: Generator) -> Iterator[Variant]:
    """B against A: there is one way to do that."""
    del samples, rng
    yield Variant("swap", "B against A", body("a", question.a), body("b", question.b), swapped=True)


def translated(question: Question, samples: int, rng: Generator) -> Iterator[Variant]:
    """Both moved by what adds to every coordinate without rounding; nothing where there is none."""
    points = question.points
    top = math.frexp(question.diagonal)[1] + 1
    for _ in range(samples):
        by = [_exact_offset(points[:, axis], top, rng) for axis in range(3)]
        if not any(by):
            return
        yield Variant(
            "translation",
            "by ({:g}, {:g}, {:g})".format(*by),
            body("a", question.a, by=by),
            body("b", question.b, by=by),
        )


def _exact_offset(coordinates: Points, top: int, rng: Generator) -> float:
    """A power of two, either way, or 0.0 where none can be added exactly."""
    for exponent in rng.permutation(np.arange(top - TRANSLATION_EXPONENTS, top)).tolist():
        for sign in rng.permutation([-1.0, 1.0]).tolist():
            offset = math.ldexp(sign, exponent)
            moved = coordinates + offset
            back = moved - offset
            # Knuth's two-sum: the rounding error of the addition, without error itself.
            error = (coordinates - back) + (offset - (moved - back))
            if not error.any():
                return offset
    return 0.0


def in_motion(question: Question, samples: int, rng: Generator) -> Iterator[Variant]:
    """Turned and moved as one; every coordinate is rounded once, and so was the rotation."""
    diagonal = question.diagonal
    centre = question.points.mean(axis=0)
    for _ in range(samples):
        turn = _rotation(rng)
        to = rng.uniform(-diagonal, diagonal, 3)
        by = (to - np.array(turn) @ centre).tolist()
        a, b = body("a", question.a, turn, by), body("b", question.b, turn, by)
        largest = [float(np.abs(body.world_mesh().vertices).max()) for body in (a, b)]
        moved = sum(rounded_once(each) for each in largest)
        yield Variant(
            "motion",
            "to ({:.3g}, {:.3g}, {:.3g})".format(*to),
            a,
            b,
            turn=turn,
            displacement=moved + stretch(turn) * diagonal,
        )


def _rotation(rng: Generator) -> Rows:
    """Uniform: K. Shoemake, "Uniform Random Rotations" (1992), by a normal 4-vector."""
    m = quaternion_matrix(*rng.normal(size=4).tolist())
    return (m[0], m[1], m[2]), (m[3], m[4], m[5]), (m[6], m[7], m[8])


def reordered(question: Question, samples: int, rng: Generator) -> Iterator[Variant]:
    """Vertices, faces and the first corner of each face in another order: the same bits."""
    for number in range(1, samples + 1):
        a, b = (_shuffled(file.mesh, rng) for file in question.files)
        yield Variant(
            "order",
            f"sample {number}",
            _body("a", question.a, a),
            _body("b", question.b, b),
            identical=True,
        )


def _shuffled(mesh: Mesh, rng: Generator) -> Mesh:
    order = rng.permutation(mesh.vertex_count)
    place = np.empty_like(order)
    place[order] = np.arange(len(order))
    triangles = place[mesh.triangles][rng.permutation(mesh.triangle_count)]
    first = rng.integers(0, 3, (len(triangles), 1))
    corners = np.take_along_axis(triangles, (first + np.arange(3)) % 3, axis=1)
    return Mesh(mesh.vertices[order], np.ascontiguousarray(corners))


def retessellated(question: Question, samples: int, rng: Generator) -> Iterator[Variant]:
    """Edges split at their middle, diagonals of flat quads turned: the same solid, unless a middle
    had to be rounded."""
    for _ in range(samples):
        results = [retessellate(file.mesh, STEPS, rng) for file in question.files]
        if not any(result.turned or result.split for result in results):
            return
        moved = sum(
            rounded_once(float(np.abs(file.mesh.vertices).max()))
            for file, result in zip(question.files, results, strict=True)
            if result.rounded
        )
        a, b = (result.mesh for result in results)
        yield Variant(
            "retessellation",
            f"{sum(result.split for result in results)} edges split, "
            f"{sum(result.turned for result in results)} diagonals turned",
            _body("a", question.a, a),
            _body("b", question.b, b),
            displacement=moved,
        )


def noisy(question: Question, samples: int, rng: Generator) -> Iterator[Variant]:
    """Each coordinate stays or goes to one of its two neighbours; 0 stays."""
    for number in range(1, samples + 1):
        a, b = (
            Mesh(_with_noise(file.mesh.vertices, rng), file.mesh.triangles)
            for file in question.files
        )
        yield Variant(
            "noise",
            f"sample {number}",
            _body("a", question.a, a),
            _body("b", question.b, b),
            displacement=sum(one_ulp(float(np.abs(mesh.vertices).max())) for mesh in (a, b)),
        )


def _with_noise(vertices: Points, rng: Generator) -> Points:
    towards = rng.choice([-np.inf, 0.0, np.inf], vertices.shape)
    moved = np.nextafter(vertices, towards)
    return np.where((towards == 0) | (vertices == 0), vertices, moved)


def _body(id_: str, file: MeshFile, mesh: Mesh) -> Body:
    return body(id_, remeshed(file, mesh))


Make = Callable[[Question, int, Generator], Iterator[Variant]]
_MAKERS: dict[Family, Make] = {
    "scale": scaled,
    "order": reordered,
    "axes": reaxed,
    "swap": swapped,
    "translation": translated,
    "retessellation": retessellated,
    "motion": in_motion,
    "noise": noisy,
}
# Why a family can have no variants.
NO_VARIANTS: dict[Family, str] = {
    "scale": "no power of two leaves the coordinates within the numeric range",
    "translation": "no translation was found that adds to every coordinate exactly",
    "retessellation": "no edge was found that could be split or turned",
}


def variants(family: Family, question: Question, samples: int, seed: int) -> Iterator[Variant]:
    """At most `samples`. Each family has random numbers of its own, so that the variants of one do
    not depend on the others."""
    rng = np.random.default_rng([seed, zlib.crc32(family.encode())])
    return _MAKERS[family](question, samples, rng)
