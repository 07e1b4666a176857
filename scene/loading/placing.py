"""From a graph of placed parts to a list of them: no circle, no explosion, a name for each."""

from __future__ import annotations

from collections.abc import Callable, Hashable, Iterable, Iterator, Sequence
from typing import Generic, TypeVar

from msgspec import Struct

from satcheck.core.transform import compose
from satcheck.scene.errors import MeshFileError
from satcheck.scene.loading import limits
from satcheck.scene.loading.raw_mesh import Matrix
from satcheck.scene.plain_ids import COMPONENT_MARK, UniqueNames

_LONGEST_NAME = 80
_LONGEST_PATH = 200  # of a deep graph the last steps are kept
_CUT = "..."

Key = TypeVar("Key", bound=Hashable)


class Instance(Struct, Generic[Key], frozen=True):
    """Part `key` at `matrix` (None: as it is). path: the names that lead to it, unique."""

    key: Key
    matrix: Matrix | None
    path: str


def instances(
    roots: Sequence[tuple[Key, Matrix | None]],
    *,
    children: Callable[[Key], Sequence[tuple[Key, Matrix | None]]],
    has_mesh: Callable[[Key], bool],
    name: Callable[[Key], str],
    kind: str,
) -> list[Instance[Key]]:
    """Every part under the roots with a mesh of its own, once for each way that leads to it.

    children: the parts placed inside a part; kind: what a part is called in messages. Depth first,
    in the order of the file. Raises MeshFileError for a circle, and for more parts than the limit.
    """
    total = _total(roots, children, lambda key: f"{kind} {name(key)!r}")
    if total > limits.MAX_PLACEMENTS:
        raise MeshFileError("too-large", f"{total} placed parts exceed {limits.MAX_PLACEMENTS}")
    paths = UniqueNames()
    found = []
    stack = list(_named("", roots, name))[::-1]
    while stack:
        path, key, matrix = stack.pop()
        if has_mesh(key):
            found.append(Instance(key, matrix, paths.unique(path)))
        below = ((child, multiply(matrix, placement)) for child, placement in children(key))
        stack.extend(list(_named(f"{path}/", below, name))[::-1])
    return found


def _named(
    prefix: str, placed: Iterable[tuple[Key, Matrix | None]], name: Callable[[Key], str]
) -> Iterator[tuple[str, Key, Matrix | None]]:
    """With the path of each; siblings of one name are numbered."""
    names = UniqueNames()
    for key, matrix in placed:
        path = prefix + names.unique(name(key))
        if len(path) > _LONGEST_PATH:
            path = _CUT + path[len(_CUT) - _LONGEST_PATH :]
        yield path, key, matrix


def tidy_name(name: object, otherwise: str) -> str:
    """A name from a file as a step of a path: printable, not too long, without the mark of
    components; `otherwise` where nothing is left."""
    if not isinstance(name, str):
        return otherwise
    shown = name[:_LONGEST_NAME]
    if not shown.isprintable():
        shown = "".join(c if c.isprintable() else " " for c in shown)
    return shown.replace(COMPONENT_MARK, "").strip() or otherwise


def _total(
    roots: Sequence[tuple[Key, Matrix | None]],
    children: Callable[[Key], Sequence[tuple[Key, Matrix | None]]],
    describe: Callable[[Key], str],
) -> int:
    """Placements of all parts together, each part visited once."""
    totals: dict[Key, int] = {}
    open_: set[Key] = set()
    stack = [(root, False) for root, _ in roots]
    while stack:
        key, closing = stack.pop()
        if closing:
            open_.discard(key)
            totals[key] = 1 + sum(totals[child] for child, _ in children(key))
        elif key in open_:
            raise MeshFileError("reference-cycle", f"{describe(key)} contains itself: a cycle")
        elif key not in totals:
            open_.add(key)
            stack.append((key, True))
            stack.extend((child, False) for child, _ in children(key))
    return sum(totals[root] for root, _ in roots)


def multiply(outer: Matrix | None, inner: Matrix | None) -> Matrix | None:
    """The placement of a part at `inner` inside a part at `outer`; both affine."""
    if outer is None or inner is None:
        return inner if outer is None else outer
    return compose(outer, inner)
