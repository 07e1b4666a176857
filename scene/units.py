"""The length units that a scene may declare. They label lengths; nothing is converted by them."""

from __future__ import annotations

_SYMBOLS = ("um", "mm", "cm", "m", "in", "ft")
_METRIC = ("micrometre", "millimetre", "centimetre", "metre", "micron")
_AMERICAN = ("micrometer", "millimeter", "centimeter", "meter")
_IMPERIAL = ("inch", "inches", "foot", "feet")
_UNITS = frozenset((*_SYMBOLS, *_METRIC, *_AMERICAN, *_IMPERIAL))


def is_unit(declared: str) -> bool:
    """Whether the first word of a declaration is a length unit: "mm", "Metres", "mm (assumed)"."""
    first = declared.partition("(")[0].split()[:1]
    return any(word in _UNITS or word.removesuffix("s") in _UNITS for word in map(str.lower, first))
