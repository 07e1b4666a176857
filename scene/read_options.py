"""Options of readers: each reader declares those choices that its format leaves to the user.

They decide the geometry of a check, so a report states them, and whoever reads the same files again
needs the same ones.
"""

from __future__ import annotations

from collections.abc import Mapping
from math import pi
from sys import float_info
from typing import Annotated, Any, Literal, get_args, get_origin

from msgspec import Meta, Struct, ValidationError, convert

from satcheck.core.errors import SatcheckError
from satcheck.scene.units import parse_length

GeometryKind = Literal["collision", "visual"]
OptionValue = bool | int | float | str | tuple[str, ...]
# By name, those that are not given left out.
ReadOptions = Mapping[str, OptionValue]


class Option(Struct, frozen=True):
    """An option of a reader.

    name: in scene files and reports; the command line also takes - for _. type: of its values, with
    their limits, such as `Annotated[float, Meta(gt=0)]`. help: one sentence, which says what it
    takes. default: None: the reader decides. is_length: in millimetres; the command line may give
    another unit. Readers may have options of one name and type, each with its default.
    """

    name: str
    type: Any
    help: str
    default: OptionValue | None = None
    is_length: bool = False

    @property
    def spelling(self) -> str:
        """Return its name on the command line."""
        return self.name.replace("_", "-")

    @property
    def choices(self) -> tuple[str, ...]:
        """Return the words that it takes; (): it takes other values."""
        return _words(self.type)

    def converted(self, value: OptionValue) -> OptionValue:
        """Return the value as the reader takes it. Raises SatcheckError."""
        try:
            made: OptionValue = convert(value, self.type)
        except ValidationError:
            raise self._refused(value) from None
        return made

    def parsed(self, text: str) -> OptionValue:
        """Return the value that a text states; a comma separates several. Raises SatcheckError."""
        try:
            made: OptionValue = convert(self._stated(text), self.type, strict=False)
        except ValueError:  # as a ValidationError is, too
            raise self._refused(text) from None
        return made

    def _stated(self, text: str) -> float | str | list[str]:
        if self.is_length:
            return parse_length(text).in_units_of("mm")
        kind = get_args(self.type)[0] if get_origin(self.type) is Annotated else self.type
        return text.split(",") if get_origin(kind) is tuple else text

    def _refused(self, value: object) -> SatcheckError:
        return SatcheckError("bad-argument", f"{self.spelling}: not {value!r}, but {self.help}")


# `--geometry` gives it.
GEOMETRY = Option("geometry", GeometryKind, "what is checked: collision or visual")


def facets(chord: float) -> tuple[Option, Option]:
    """Return the options of a reader that makes facets of curved faces. chord: its default."""
    return (
        Option(
            "chord_tolerance",
            Annotated[float, Meta(gt=0, le=float_info.max)],
            "how far facets may be off, in millimetres, above 0",
            chord,
            is_length=True,
        ),
        Option(
            "angular_tolerance",
            Annotated[float, Meta(gt=0, le=pi)],
            "the largest angle between facets, in radians, up to pi",
            0.5,
        ),
    )


def _words(kind: Any) -> tuple[str, ...]:
    if get_origin(kind) is Literal:
        return get_args(kind)
    return tuple(word for inner in get_args(kind) for word in _words(inner))
