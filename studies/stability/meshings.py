"""Variants that store the same solids otherwise: another order, other triangles, one ulp off."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from numpy.random import Generator

from satcheck.core import Mesh
from satcheck.scene import Body, MeshFile
from satcheck.scene.shape_file import remeshed
from satcheck.studies.stability.bounds import one_ulp, rounded_once
from satcheck.studies.stability.retessellation import retessellate
from satcheck.studies.stability.variant import Points, Question, Variant, body

# Edges split and diagonals turned in each mesh of a sample.
STEPS = 12


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
        found = [retessellate(file.mesh, STEPS, rng) for file in question.files]
        if not any(one.turned or one.split for one in found):
            return
        moved = sum(
            rounded_once(float(np.abs(file.mesh.vertices).max()))
            for file, one in zip(question.files, found, strict=True)
            if one.rounded
        )
        a, b = (one.mesh for one in found)
        yield Variant(
            "retessellation",
            f"{sum(one.split for one in found)} edges split, "
            f"{sum(one.turned for one in found)} diagonals turned",
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
