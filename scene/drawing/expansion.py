"""What references expand to, counted before any of it is made: no circle, no explosion."""

from __future__ import annotations

from collections.abc import Callable, Hashable, Iterable
from typing import TypeVar

from satcheck.scene.errors import MeshFileError
from satcheck.scene.loading.limits import MAX_PLACEMENTS

MAX_DEPTH = 200  # of things within things: deeper than any program writes them

Key = TypeVar("Key", bound=Hashable)


def refuse_explosion(
    root: Key,
    within: Callable[[Key], Iterable[tuple[Key, int]]],
    size: Callable[[Key], int],
    describe: Callable[[Key], str],
) -> None:
    """within: what a thing holds directly, and how often. size: what it counts by itself, without
    that. Each thing is visited once.

    Raises MeshFileError: a thing contains itself, or is too deep or too much in all.
    """
    totals: dict[Key, int] = {}
    depths: dict[Key, int] = {}
    open_: set[Key] = set()
    stack = [(root, False)]
    while stack:
        key, closing = stack.pop()
        if closing:
            open_.discard(key)
            held = list(within(key))
            totals[key] = size(key) + sum(times * totals[child] for child, times in held)
            depths[key] = 1 + max((depths[child] for child, _ in held), default=0)
        elif key in open_:
            raise MeshFileError("reference-cycle", f"{describe(key)} contains itself: a cycle")
        elif key not in totals:
            open_.add(key)
            stack.append((key, True))
            stack.extend((child, False) for child, _ in within(key))
    if totals[root] > MAX_PLACEMENTS:
        message = f"its references expand to more than {MAX_PLACEMENTS} elements"
        raise MeshFileError("too-large", message)
    if depths[root] > MAX_DEPTH:
        raise MeshFileError("too-large", f"elements are nested deeper than {MAX_DEPTH}")
