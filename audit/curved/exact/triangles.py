"""The triangles of a mesh of which bounds do not tell whether a curved shape meets them."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import chain

import numpy as np

from satcheck.audit.curved.exact.axes import candidates
from satcheck.audit.curved.exact.curved_body import CurvedBody
from satcheck.audit.curved.exact.lattice import Vector, direction_of
from satcheck.audit.curved.exact.pair import Faces, Lattice, with_proof
from satcheck.audit.curved.exact.polytope_body import Floats, PolytopeBody
from satcheck.audit.curved.exact.proof import prove
from satcheck.audit.curved.signed import Signed
from satcheck.scene.shape_image import ShapeImage

_ALONE = np.array([[0, 1, 2]], dtype=np.uint32)
# Of the triangles that a face stands on a few points of contact are enough.
MOST_CONTACTS = 8


def refined(image: ShapeImage, corners: Floats, found: Sequence[Signed]) -> list[Signed]:
    """corners: (n, 3, 3), world, of the triangles that `found` is about, the shape being A."""
    lattice = Lattice((image, Faces(corners.reshape(-1, 3), _ALONE)))
    shape = CurvedBody(image, lattice.bits, lattice.matrix_bits)
    known: list[Vector] = []  # one of them is the axis of most others
    touched, done = 0, []
    for points, one in zip(corners, found, strict=True):
        triangle = PolytopeBody(points, _ALONE, lattice.bits)
        if not triangle.face_normals():  # without an area it is its neighbours' edges
            done.append(one)
            continue
        toward = direction_of(one.normal or (0.0, 0.0, 1.0))
        axes = chain(known, candidates(shape, triangle, toward))
        proof = prove(shape, triangle, axes, contact=touched < MOST_CONTACTS)
        if proof is not None:
            touched += proof.outcome == "touching"
            if proof.axis not in known:
                known.append(proof.axis)
        done.append(one if proof is None else with_proof(one, proof, lattice.bits))
    return done
