"""Expands a graph of placed parts into a list with names. Cycles and huge expansions are errors."""

from __future__ import annotations

from collections.abc import Callable, Hashable, Sequence
from typing import Generic, TypeVar

from msgspec import Struct

from satcheck.core.shapes import Primitive
from satcheck.core.transform import Transform, compose
from satcheck.scene.document import (
    COMPONENT_MARK,
    Document,
    Item,
    RawMesh,
    RawPart,
    Refusal,
    UniqueNames,
)
from satcheck.scene.errors import Refused
from satcheck.scene.files import limits

_LONGEST_NAME = 80
_LONGEST_PATH = 200  # characters; of a longer path only the end is kept
_CUT = "..."

Key = TypeVar("Key", bound=Hashable)


class Instance(Struct, Generic[Key], frozen=True):
    """Part `key` at `matrix` (None: identity). path: the names that lead to it, unique."""

    key: Key
    matrix: Transform | None
    path: str


def instances(
    roots: Sequence[tuple[Key, Transform | None]],
    *,
    children: Callable[[Key], Sequence[tuple[Key, Transform | None]]],
    has_mesh: Callable[[Key], bool],
    name: Callable[[Key], str],
    kind: str,
) -> list[Instance[Key]]:
    """Every part under the roots that has a mesh, once for each path that leads to it.

    children: the parts placed inside a part; kind: the noun for a part in messages. Depth first, in
    file order. Raises Refused for a cycle, and for more parts than the limit.
    """
    refuse_explosion(
        [root for root, _ in roots],
        lambda key: [child for child, _ in children(key)],
        lambda key: f"{kind} {name(key)!r}",
    )
    paths = UniqueNames()
    placed = []
    stack = _named("", None, roots, name)
    while stack:
        path, key, matrix = stack.pop()
        if has_mesh(key):
            placed.append(Instance(key, matrix, paths.unique(path)))
        if below := children(key):
            stack += _named(f"{path}/", matrix, below, name)
    return placed


def _named(
    prefix: str,
    outer: Transform | None,
    placed: Sequence[tuple[Key, Transform | None]],
    name: Callable[[Key], str],
) -> list[tuple[str, Key, Transform | None]]:
    """The path and the placement of each, the last one first. Siblings with the same name are
    numbered. outer: where they are placed."""
    names = UniqueNames()
    made = []
    for key, matrix in placed:
        path = prefix + names.unique(name(key))
        if len(path) > _LONGEST_PATH:
            path = _CUT + path[len(_CUT) - _LONGEST_PATH :]
        made.append((path, key, multiply(outer, matrix)))
    return made[::-1]


def tidy_name(name: object, otherwise: str) -> str:
    """A name from a file as a step of a path: printable, not too long, and without the mark of
    components; `otherwise` if the result is empty."""
    if not isinstance(name, str):
        return otherwise
    shown = name[:_LONGEST_NAME]
    if not shown.isprintable():
        shown = "".join(c if c.isprintable() else " " for c in shown)
    return shown.replace(COMPONENT_MARK, "").strip() or otherwise


def refuse_explosion(
    roots: Sequence[Key],
    within: Callable[[Key], Sequence[Key]],
    describe: Callable[[Key], str],
) -> None:
    """Counts the elements that references expand to, before any is created.

    Visits each element once. within: the direct children of an element. Raises Refused if an
    element contains itself, or expands to too many elements.
    """
    totals: dict[Key, int] = {}
    open_: set[Key] = set()
    stack: list[tuple[Key, Sequence[Key] | None]] = [(root, None) for root in roots]
    while stack:
        key, below = stack.pop()
        if below is not None:
            open_.discard(key)
            total = 1 + sum([totals[child] for child in below])
            totals[key] = min(total, limits.MAX_PLACEMENTS + 1)  # 2^100 needs no more digits
        elif key in open_:
            raise Refused("reference-cycle", f"{describe(key)} contains itself: a cycle")
        elif key not in totals:
            below = within(key)
            if not below:
                totals[key] = 1
                continue
            open_.add(key)
            stack.append((key, below))
            stack += [(child, None) for child in below]
    limits.refuse_many(
        sum(totals[root] for root in roots), "elements that its references expand to"
    )


def raw_scene(
    nodes: Sequence[Instance[Key]],
    name: Callable[[Key], str],
    mesh: Callable[[Key], RawMesh | Refusal],
) -> Document:
    """A scene with each part once, even if many nodes use it."""
    used: dict[Key, int] = {}
    items = [Item(used.setdefault(node.key, len(used)), node.path, node.matrix) for node in nodes]
    names = UniqueNames()
    parts = [RawPart(names.unique(name(key)), mesh(key)) for key in used]
    return Document(tuple(parts), tuple(items))


class Parts:
    """The parts of a document: equal meshes and shapes once, each refusal by itself."""

    def __init__(self) -> None:
        self._parts: dict[Hashable, RawPart] = {}
        self._numbers: dict[Hashable, int] = {}

    def number(self, name: str, shape: RawMesh | Primitive | Refusal) -> int:
        """Return the number of the part. name: of the part if it is new, unique."""
        key = (name, shape) if isinstance(shape, Refusal) else shape
        self._parts.setdefault(key, RawPart(name, shape))
        return self._numbers.setdefault(key, len(self._numbers))

    def all(self) -> tuple[RawPart, ...]:
        return tuple(self._parts.values())


def multiply(outer: Transform | None, inner: Transform | None) -> Transform | None:
    """The placement of a part at `inner` inside a part at `outer`; both affine."""
    if outer is None or inner is None:
        return inner if outer is None else outer
    return compose(outer, inner)
