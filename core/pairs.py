"""Checks pairs of convex shapes, with clear messages for wrong arguments.

For a wrong argument, the compiled functions list all types that they accept. The functions here
call them first, and inspect the arguments only if a call fails.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any, Literal, NoReturn, TypeAlias, get_args

from satcheck._native import core as native
from satcheck._native.core import PairResult, PairResults, Shape

if TYPE_CHECKING:
    from numpy import float64, uint32
    from numpy.typing import NDArray

# None (at the origin), (tx, ty, tz), or (tx, ty, tz, qx, qy, qz, qw).
Pose: TypeAlias = "Sequence[float] | None"
Query = Literal["overlap", "depth", "distance"]
MethodChoice = Literal["auto", "sat", "gjk"]
LONGEST_SHOWN = 60  # characters of a value in a message


def check_pair(
    a: Shape,
    b: Shape,
    pose_a: Pose = None,
    pose_b: Pose = None,
    *,
    query: Query = "depth",
    method: MethodChoice = "auto",
    enough: float = math.inf,
) -> PairResult:
    """Check two placed convex shapes.

    pose_a, pose_b: None, (tx, ty, tz) or (tx, ty, tz, qx, qy, qz, qw): rotate by the quaternion
    (any length except 0), then translate. query: "overlap" gives the outcome only and stops at the
    first proof; "depth" and "distance" give the signed distance, normal and witness points. method:
    "auto", "sat" (projections on axes, for shapes with faces), or "gjk" (support functions only:
    portals for the outcome of an overlap, GJK and EPA for the rest). enough: a pair that is proven
    to be deeper may have no figures, as for "overlap".

    Raises TypeError for wrong types, ValueError for a pose that is not finite or an unknown query
    or method, OverflowError for a translation out of range.

    SAT (Gottschalk, Lin, Manocha 1996; Gregorius 2013), portals (Snethen 2008), GJK (Gilbert,
    Johnson, Keerthi 1988), EPA on signed face distances (after van den Bergen 2001), exact signs
    (Shewchuk 1997) if float64 cannot decide.
    """
    try:
        return native.check_pair(a, b, pose_a, pose_b, query, method, enough)
    except TypeError:
        _require_two_shapes(a, b, pose_a, pose_b)
        _require_words(query, method)
        raise


def compare_signed_distance(
    a: Shape, b: Shape, length: float, pose_a: Pose = None, pose_b: Pose = None
) -> Literal[-1, 0, 1] | None:
    """-1, 0 or 1: the signed distance is smaller than, equal to, or larger than the length.

    a, b: placed convex shapes, poses as for check_pair. length: negative for a depth. The decision
    is exact for the rounded world coordinates of vertices, centres and axes. None: one of them is a
    cylinder, cone or ellipsoid, or it takes too many steps.
    """
    try:
        return native.compare_signed_distance(a, b, length, pose_a, pose_b)
    except TypeError:
        _require_two_shapes(a, b, pose_a, pose_b)
        _refuse("length", "a number", length)


def check_pairs(
    shapes: Sequence[Shape],
    index_a: NDArray[uint32],
    index_b: NDArray[uint32],
    poses_a: NDArray[float64],
    poses_b: NDArray[float64],
    *,
    query: Query = "depth",
    method: MethodChoice = "auto",
    threads: int = 0,
) -> PairResults:
    """check_pair for many pairs at once, on `threads` threads (0: one for each core), without the
    GIL.

    Pair i is shapes[index_a[i]] at poses_a[i] against shapes[index_b[i]] at poses_b[i]. index_a,
    index_b: uint32 (n,). poses_a, poses_b: float64 (n, 7), each row tx, ty, tz, qx, qy, qz, qw. The
    results are bitwise equal for any number of threads.

    Raises TypeError for other arrays, ValueError when lengths differ, an index is out of range or a
    pose is not finite.
    """
    try:
        return native.check_pairs(
            shapes,
            index_a,
            index_b,
            poses_a,
            poses_b,
            query=query,
            method=method,
            threads=threads,
        )
    except TypeError:
        if not isinstance(shapes, Sequence) or not all(isinstance(s, Shape) for s in shapes):
            _refuse("shapes", "a sequence of convex shapes", shapes)
        for name, indices in (("index_a", index_a), ("index_b", index_b)):
            _require_array(name, indices, "uint32", (-1,))
        for name, poses in (("poses_a", poses_a), ("poses_b", poses_b)):
            _require_array(name, poses, "float64", (-1, 7))
        _require_words(query, method)
        _refuse("threads", "an integer >= 0", threads)


def _require_two_shapes(a: object, b: object, pose_a: Any, pose_b: Any) -> None:
    for name, shape in (("a", a), ("b", b)):
        if not isinstance(shape, Shape):
            _refuse(name, "a convex shape", shape)
    for name, pose in (("pose_a", pose_a), ("pose_b", pose_b)):
        if pose is not None and not _is_numbers(pose):
            _refuse(name, "(tx, ty, tz) or (tx, ty, tz, qx, qy, qz, qw)", pose)


def _is_numbers(values: Any) -> bool:
    try:
        return all(float(value) is not None for value in values)
    except (TypeError, ValueError):
        return False


def _require_words(query: object, method: object) -> None:
    for name, word, words in (("query", query, Query), ("method", method, MethodChoice)):
        if word not in get_args(words):
            _refuse(name, " or ".join(map(repr, get_args(words))), word)


def _require_array(name: str, values: Any, dtype: str, shape: tuple[int, ...]) -> None:
    given = getattr(values, "shape", ())
    fits = len(given) == len(shape) and shape[1:] == given[1:]
    if not fits or str(values.dtype) != dtype or not values.flags.c_contiguous:
        rows = "(n,)" if len(shape) == 1 else f"(n, {shape[1]})"
        _refuse(name, f"a C-contiguous {rows} array of {dtype}", values)


def _refuse(name: str, expected: str, value: Any) -> NoReturn:
    if hasattr(value, "dtype"):
        contiguous = "" if value.flags.c_contiguous else ", not C-contiguous"
        given = f"{value.dtype} of shape {value.shape}{contiguous}"
    else:
        given = repr(value) if len(repr(value)) <= LONGEST_SHOWN else type(value).__name__
    raise TypeError(f"{name}: {expected} expected, got {given}") from None
