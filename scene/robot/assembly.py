"""A robot in a scene: the bodies of its links, and the pairs of them that may touch."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from itertools import combinations, product
from typing import Any

from msgspec import Struct, field
from msgspec.structs import replace

from satcheck.core.shapes import Primitive
from satcheck.core.transform import Transform, compose
from satcheck.scene.bodies import IDENTITY, Entry
from satcheck.scene.document import HULL_MARK, Document, FilePart, Item, Refusal
from satcheck.scene.errors import Refused
from satcheck.scene.files.readers import GEOMETRY, File, GeometryKind
from satcheck.scene.issue import Issue, issue
from satcheck.scene.robot.kinematics import scaled
from satcheck.scene.robot.model import Collision, MeshReference, Robot, State
from satcheck.scene.robot.packages import FilePlaces
from satcheck.scene.robot.srdf import Srdf
from satcheck.scene.rules import Rule, Selector
from satcheck.scene.words import listed, meant

UNITS = "m"  # of every URDF, SDFormat and MJCF file
SAME_LINK = "one rigid link"
# If a link has more bodies, they are a group with one rule, in place of a rule for each pair.
MOST_NAMED = 100


class RobotBody(Struct, frozen=True):
    """A body of a link of a robot, readable or not. groups: as the robot names them."""

    id: str
    link: str
    offset: Transform
    groups: tuple[str, ...] = ()


class Kept:
    """What a check of poses derives from the meshes of a robot, for the next one. It is no part of
    the robot: a copy begins without it, and all are equal."""

    def __init__(self) -> None:
        self._terms: object = None
        self._meshes: dict[Any, Any] = {}

    def meshes(self, terms: object) -> dict[Any, Any]:
        """Return the meshes. terms: what they depend on; others are no longer kept."""
        if terms != self._terms:
            self._terms, self._meshes = terms, {}
        return self._meshes

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Kept)

    def __hash__(self) -> int:
        return hash(Kept)

    def __repr__(self) -> str:
        return "Kept()"

    def __reduce__(self) -> tuple[type[Kept], tuple[()]]:
        return Kept, ()


class SceneRobot(Struct, frozen=True):
    """A robot, its bodies, and its SRDF. groups: as the robot names them -> as the check does.
    loose: its bodies stand where a document places them, so they may be moved without it."""

    robot: Robot
    bodies: tuple[RobotBody, ...]
    srdf: Srdf | None = None
    groups: Mapping[str, str] = {}
    loose: bool = False
    kept: Kept = field(default_factory=Kept)

    @property
    def states(self) -> tuple[State, ...]:
        return (*self.robot.states, *(self.srdf.states if self.srdf else ()))

    def bodies_of(self, link: str) -> list[str]:
        return self.by_link().get(link, [])

    def by_link(self) -> dict[str, list[str]]:
        """The bodies of each link that has any."""
        links: dict[str, list[str]] = {}
        for body in self.bodies:
            links.setdefault(body.link, []).append(body.id)
        return links

    @property
    def pairs_within_links(self) -> int:
        """The number of pairs of bodies on the same link. They are never checked."""
        return sum(len(own) * (len(own) - 1) // 2 for own in self.by_link().values())

    def neighbours(self) -> list[tuple[str, str]]:
        """Pairs (parent, child) of links with bodies that are connected by a joint. Links without
        bodies between them count as part of the joint."""
        solid = {body.link for body in self.bodies}
        carrier = {joint.child: joint.parent for joint in self.robot.joints}
        pairs = []
        for link in (link for link in self.robot.links if link in solid):
            above = carrier.get(link)
            while above is not None and above not in solid:
                above = carrier.get(above)
            if above is not None:
                pairs.append((above, link))
        return pairs


def document_of_robot(read: Document, file: File) -> Document:
    """Return what the reader of a file has read, with an item for each <collision>.

    The id of an item is the name of the link; if the link has several, "link/name" or
    "link/number". Items that fail for the same cause share one message, which states their number.
    """
    robot = read.robot
    assert robot is not None
    places = FilePlaces(file.path, file.packages, file.permitted)
    items: list[Item] = []
    lost: dict[tuple[str, str], list[Collision]] = {}
    for link in robot.links.values():
        group = (_group_of(link.name),) if len(link.collisions) > MOST_NAMED else ()
        for number, collision in enumerate(link.collisions, 1):
            shape = _shape(collision, places.of(collision.file or robot.file))
            if isinstance(shape, Refused):
                lost.setdefault((shape.code, shape.message), []).append(collision)
            alone = len(link.collisions) == 1
            item = Item(
                id=link.name if alone else f"{link.name}/{collision.name or number}",
                link=link.name,
                transform=_offset(collision),
                shape=shape,
                static=link.static,
                groups=(*collision.groups, *group),
                entry=Entry(collision.file or robot.file, line=collision.line),
            )
            items.append(item)
    causes = {key: _placed(*key, alike) for key, alike in lost.items()}
    return replace(
        read,
        path=robot.file,
        name=robot.name,
        kind="robot",
        units=UNITS,
        items=tuple(
            replace(item, shape=causes[item.shape.code, item.shape.message])
            if isinstance(item.shape, Refused)
            else item
            for item in items
        ),
        issues=(*read.issues, *_about_geometry(robot, file.options[GEOMETRY.name])),
    )


def _about_geometry(robot: Robot, checked: GeometryKind) -> Iterator[Issue]:
    """Yield issues about what is not checked: the other kind of geometry."""
    if checked == "visual":
        message = "visual geometry is checked, not collision geometry"
        yield issue("visual-geometry", message, file=robot.file)
    bare = [link.name for link in robot.links.values() if link.unused and not link.collisions]
    if bare:
        have = "link has" if len(bare) == 1 else "links have"
        others = "visual" if checked == "collision" else "collision"
        message = (
            f"{len(bare)} {have} {others} geometry and no {checked} geometry, so no body is "
            f"checked: {listed(bare)}"
        )
        yield issue("no-collision-geometry", message, file=robot.file)


def _shape(collision: Collision, places: FilePlaces) -> FilePart | Primitive | Refused:
    match collision.geometry:
        case MeshReference(uri, part=part, hull=hull):
            try:
                found = places.locate(uri)
            except Refused as error:
                return error
            wanted = f"{part or ''}{HULL_MARK}" if hull else part
            return FilePart(found.as_posix(), str(found), wanted)
        case Refusal(code, reason):
            return Refused(code, reason)
    return collision.geometry


def _offset(collision: Collision) -> Transform:
    shape = collision.geometry
    if not isinstance(shape, MeshReference):
        return collision.origin
    placing = scaled(collision.origin, shape.scale)
    return placing if shape.start == IDENTITY else compose(placing, shape.start)


def _placed(code: str, message: str, lost: Sequence[Collision]) -> Refused:
    """The cause, with the number of bodies that it affects, and its first place in the file."""
    first, number = lost[0], len(lost)
    place = f"line {first.line}" if first.line else "the file"
    if isinstance(first.geometry, MeshReference):
        place += f": {first.geometry.uri!r}" if number == 1 else f" ({first.geometry.uri})"
    start = place if number == 1 else f"{number} bodies, the first in {place}"
    return Refused(code, f"{start}: {message}")


def with_srdfs(robots: Sequence[SceneRobot], srdfs: Iterable[Srdf]) -> list[SceneRobot]:
    """Each robot with its SRDF: the SRDF with its name, or the only SRDF if there is only one
    robot.

    Raises Refused if an SRDF has no robot, or if a robot has two SRDFs.
    """
    matched = list(robots)
    for srdf in srdfs:
        alone = len(matched) == 1
        named = [k for k, robot in enumerate(matched) if alone or robot.robot.name == srdf.robot]
        if not named:
            names = ", ".join(robot.robot.name for robot in matched) or "no URDF is given"
            message = f"about robot {srdf.robot!r}, which is not given ({names})"
            raise Refused("bad-robot", message, file=srdf.file)
        for k in named:
            if matched[k].srdf is not None:
                message = f"a second SRDF about robot {matched[k].robot.name!r}"
                raise Refused("bad-robot", message, file=srdf.file)
            matched[k] = replace(matched[k], srdf=srdf)
    return matched


def permissions(robot: SceneRobot) -> tuple[list[Rule], list[Issue]]:
    """(rules for the pairs of its bodies that may touch, issues about them): those within a link,
    and those that its format or its SRDF names."""
    srdf, bodies = robot.srdf, robot.by_link()
    rules = [*_within_links(robot, bodies), *_exempted(robot, bodies)]
    if srdf is None:
        return rules, list(_checked_neighbours(robot))
    for a, b in combinations(bodies, 2):
        reason = srdf.permission(a, b)
        if reason is not None:
            rules += [_allowed(pair, reason, srdf.file) for pair in product(bodies[a], bodies[b])]
    return rules, [*_about_srdf(robot, srdf), *_checked_neighbours(robot)]


def _within_links(robot: SceneRobot, bodies: Mapping[str, Sequence[str]]) -> Iterator[Rule]:
    """bodies: of each link."""
    file = robot.robot.file
    for link, own in bodies.items():
        group = robot.groups.get(_group_of(link))
        if group is None:
            yield from (_allowed(pair, SAME_LINK, file) for pair in combinations(own, 2))
        elif len(own) > 1:
            yield _allowed((group, group), SAME_LINK, file, Selector.exactly_group)


def _group_of(link: str) -> str:
    """Return the group of the bodies of a link, if they are many."""
    return f"all of {link}"


def _exempted(robot: SceneRobot, bodies: Mapping[str, Sequence[str]]) -> Iterator[Rule]:
    """The rules of the format. bodies: of each link."""
    file = robot.robot.file
    members = Counter(group for body in robot.bodies for group in body.groups)
    for exempt in robot.robot.exempt or ():
        a, b = exempt.a, exempt.b
        if not exempt.of_groups:
            for pair in product(bodies.get(a, ()), bodies.get(b, ())):
                yield _allowed(pair, exempt.reason, file)
        elif members[a] and members[b] and (a != b or members[a] > 1):
            pair = robot.groups[a], robot.groups[b]
            rule = _allowed(pair, exempt.reason, file, Selector.exactly_group)
            yield replace(rule, allowed=not exempt.checked)


def _allowed(
    pair: tuple[str, str],
    reason: str,
    file: str,
    select: Callable[[str], Selector] = Selector.exactly,
) -> Rule:
    a, b = map(select, pair)
    return Rule(a=a, b=b, allowed=True, reason=reason, where=file, file=file)


def _about_srdf(robot: SceneRobot, srdf: Srdf) -> Iterator[Issue]:
    """Yield issues about another name of the robot, names that are not read, and links that the
    robot lacks. A pair that should be checked all the same blocks a pass."""
    name, links = robot.robot.name, robot.robot.links
    if srdf.robot != name:
        message = f"it names robot {srdf.robot!r} and is applied to {name!r}"
        yield issue("other-robot", message, file=srdf.file)
    yield from srdf.issues
    for link in sorted(srdf.links() - links.keys()):
        message = f"{srdf.file}: link {link!r} is not in the URDF: its entries are ignored"
        yield issue("unknown-body", message, file=srdf.file)
    for pair in sorted(map(sorted, srdf.enabled)):
        for link in sorted({*pair} - links.keys()):
            message = (
                f"enable_collisions names link {link!r}, which the robot lacks"
                f"{meant(link, links)}: the pair of {' and '.join(pair)} is not enabled"
            )
            yield issue("unread", message, file=srdf.file)


def _checked_neighbours(robot: SceneRobot) -> Iterator[Issue]:
    if robot.robot.exempt is not None:
        return
    permitted = robot.srdf.permission if robot.srdf else lambda *_: None
    checked = [f"{a} and {b}" for a, b in robot.neighbours() if permitted(a, b) is None]
    if checked:
        pairs, are = ("pair", "is") if len(checked) == 1 else ("pairs", "are")
        message = (
            f"{len(checked)} {pairs} of links with a joint between them {are} checked like any "
            "other, as no SRDF allows them to touch (suggest --format srdf writes one): "
            f"{listed(checked)}"
        )
        yield issue("neighbours-checked", message, file=robot.robot.file)
