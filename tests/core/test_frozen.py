"""`@frozen` does what a frozen dataclass does, and a wrong call fails as it does there."""

from __future__ import annotations

import copy
import pickle
from typing import Generic, TypeVar

import pytest

from satcheck.core.frozen import as_dict, derived, fields, frozen, replace

K = TypeVar("K")


@frozen
class Point:
    """A point."""

    x: float
    y: float = 0.0

    @property
    def sum(self) -> float:
        return self.x + self.y


@frozen(kw_only=True)
class Track:
    name: str = ""
    points: tuple[Point, ...]


@frozen
class Square:
    side: float
    area: float = derived()

    def __post_init__(self) -> None:
        object.__setattr__(self, "area", self.side**2)


@frozen
class Range(Generic[K]):
    low: K
    high: K

    def __post_init__(self) -> None:
        if self.low == self.high:
            raise ValueError("empty")


def test_fields_come_by_place_by_name_and_by_default() -> None:
    assert Point(1.0, 2.0) == Point(y=2.0, x=1.0) == Point(x=1.0, y=2.0)
    assert Point(1.0).y == 0.0
    assert Point(1.0, 2.0).sum == 3.0
    assert (Point.__name__, Point.__qualname__, Point.__doc__) == ("Point", "Point", "A point.")


def test_a_wrong_call_is_refused() -> None:
    with pytest.raises(TypeError, match=r"Point\.__init__.* missing .*'x'"):
        Point()  # type: ignore[call-arg]
    with pytest.raises(TypeError, match="unexpected keyword argument 'z'"):
        Point(1.0, z=1.0)  # type: ignore[call-arg]
    with pytest.raises(TypeError, match="positional"):
        Track((Point(1.0),))  # type: ignore[call-arg, arg-type]
    assert Track(points=(Point(1.0),)).name == ""


def test_a_value_does_not_change() -> None:
    point = Point(1.0)
    with pytest.raises(AttributeError, match=r"Point\.x: a value does not change"):
        point.x = 2.0  # type: ignore[misc]
    with pytest.raises(AttributeError, match="does not change"):
        del point.x
    with pytest.raises(AttributeError, match="does not change"):
        point.z = 2.0  # type: ignore[attr-defined]
    assert not hasattr(point, "__dict__")
    assert point == Point(1.0)


def test_values_are_equal_by_class_and_fields() -> None:
    assert Point(1.0, 2.0) != Point(2.0, 1.0)
    others: list[object] = [Range(1.0, 2.0), (1.0, 2.0), None]
    assert Point(1.0, 2.0) not in others
    assert {Point(1.0), Point(1.0, 0.0), Point(2.0)} == {Point(1.0), Point(2.0)}


def test_a_value_is_shown_by_its_fields_and_bytes_by_their_number() -> None:
    assert repr(Track(points=(Point(1.0),))) == "Track(name='', points=(Point(x=1.0, y=0.0),))"
    assert repr(Range(b"abc", b"")) == "Range(low=<3 bytes>, high=<0 bytes>)"


def test_a_value_is_looked_at_once_when_it_is_made() -> None:
    with pytest.raises(ValueError, match="empty"):
        Range(1, 1)
    with pytest.raises(ValueError, match="empty"):
        replace(Range(1, 2), high=1)
    assert Range(1, 2) == Range(low=1, high=2)


def test_a_derived_field_is_not_given() -> None:
    assert Square(3.0).area == 9.0
    assert replace(Square(3.0), side=2.0) == Square(2.0) != Square(3.0)
    assert as_dict(Square(2.0)) == {"side": 2.0, "area": 4.0}
    assert copy.copy(Square(2.0)).area == 4.0
    with pytest.raises(TypeError, match="positional"):
        Square(3.0, 9.0)  # type: ignore[call-arg]


def test_replace_makes_another() -> None:
    point = Point(1.0, 2.0)
    assert replace(point, y=3.0) == Point(1.0, 3.0)
    assert point == Point(1.0, 2.0)
    with pytest.raises(TypeError, match="'z'"):
        replace(point, z=3.0)


def test_fields_and_plain_values() -> None:
    assert fields(Point) == fields(Point(1.0)) == ("x", "y")
    track = Track(name="a", points=(Point(1.0), Point(2.0)))
    plain = {"name": "a", "points": ({"x": 1.0, "y": 0.0}, {"x": 2.0, "y": 0.0})}
    assert as_dict(track) == plain


def test_a_value_is_matched() -> None:
    match Point(1.0, 2.0):
        case Point(x, y):
            assert (x, y) == (1.0, 2.0)
        case _:
            raise AssertionError


@pytest.mark.parametrize("value", [Point(1.0, 2.0), Track(points=(Point(1.0),)), Range("a", "b")])
def test_a_value_is_copied_and_pickled(value: object) -> None:
    assert copy.deepcopy(value) == copy.copy(value) == pickle.loads(pickle.dumps(value)) == value
