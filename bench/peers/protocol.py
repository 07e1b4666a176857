"""The lines that a peer reads and writes.

In:  vertices and triangles of A as two counts, its coordinates, its indices; the same of B.
Out: `overlap distance nx ny nz`: 1 or 0; the signed distance, > 0 a gap, < 0 minus the depth; the
     unit normal from A to B; NaN where the peer gives none. Or one word: `unsupported` where it
     cannot take the shape, `exception`.
"""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Points = NDArray[np.float64]
Triangles = NDArray[np.int64]


@dataclass(frozen=True, slots=True)
class Body:
    """A convex mesh: vertices (n, 3), triangles (m, 3) counter-clockwise from outside."""

    vertices: Points
    triangles: Triangles


@dataclass(frozen=True, slots=True)
class Answer:
    """status: `ok`, `unsupported`, `exception`, and from the parent `crash` and `hang`."""

    status: str
    overlap: bool = False
    distance: float = float("nan")
    normal: tuple[float, float, float] = (float("nan"),) * 3


class Unsupported(Exception):
    """The peer has no such shape."""


def line_of(a: Body, b: Body) -> str:
    words: list[str] = []
    for body in (a, b):
        words += [str(len(body.vertices)), str(len(body.triangles))]
        words += [repr(c) for c in body.vertices.ravel().tolist()]
        words += [str(i) for i in body.triangles.ravel().tolist()]
    return " ".join(words)


def pair_of(line: str) -> tuple[Body, Body]:
    words = iter(line.split())
    return _body(words), _body(words)


def _body(words: Iterator[str]) -> Body:
    vertices, triangles = int(next(words)), int(next(words))
    points = np.array([float(next(words)) for _ in range(3 * vertices)])
    faces = np.array([int(next(words)) for _ in range(3 * triangles)], dtype=np.int64)
    return Body(points.reshape(-1, 3), faces.reshape(-1, 3))


def answer_of(line: str) -> Answer:
    words = line.split()
    if len(words) == 1:
        return Answer(words[0])
    overlap, distance, *normal = (float(word) for word in words)
    return Answer("ok", overlap == 1.0, distance, (normal[0], normal[1], normal[2]))


def serve(ask: Callable[[Body, Body], Answer]) -> None:
    """Answers standard input line by line until it ends."""
    for line in sys.stdin:
        try:
            given = ask(*pair_of(line))
            text = " ".join(
                [
                    str(int(given.overlap)),
                    *(repr(float(c)) for c in (given.distance, *given.normal)),
                ]
            )
        except Unsupported:
            text = "unsupported"
        except Exception:  # noqa: BLE001 whatever a library throws is its answer
            text = "exception"
        sys.stdout.write(text + "\n")
        sys.stdout.flush()
