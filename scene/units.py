"""Units of length: their names, and how many of one are another."""

from __future__ import annotations

import math
import re
from functools import lru_cache

from msgspec import Struct

# Micrometres of one unit: whole numbers, so that a conversion rounds once.
MICROMETRES = {"um": 1, "mm": 1_000, "cm": 10_000, "m": 1_000_000, "in": 25_400, "ft": 304_800}
_SYNONYMS = {
    "micrometre": "um",
    "micrometer": "um",
    "micron": "um",
    "millimetre": "mm",
    "millimeter": "mm",
    "centimetre": "cm",
    "centimeter": "cm",
    "metre": "m",
    "meter": "m",
    "inch": "in",
    "foot": "ft",
    "feet": "ft",
    "inches": "in",
}
# How the reader of COLLADA gives the unit of a file: "0.0254 * meters".
_OF_METRES = " * meters"
_SAME = 1e-9  # relative: a factor in a few digits is that of the unit
# Few calls need it: compiled at its first use.
_LENGTH = r"\s*(\+?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?)\s*([a-zA-Z]*)\s*"


class Length(Struct, frozen=True):
    """A length >= 0 as written. unit None: in the units of the files."""

    value: float
    unit: str | None

    def __str__(self) -> str:
        return f"{self.value:g}{self.unit or ''}"

    def in_units_of(self, declared: str | None) -> float:
        """This length in the declared units of a scene; ValueError where they are unknown."""
        if self.unit is None:
            return self.value
        known = unit_of(declared)
        if known is None:
            why = f"{declared!r} is no known unit" if declared else "no units are declared"
            raise ValueError(f"{self}: {why}, so give a plain number")
        return self.value * MICROMETRES[self.unit] / MICROMETRES[known]


def parse_length(text: str) -> Length:
    """`0.5` or `2mm`; ValueError for what is not a length."""
    match = re.fullmatch(_LENGTH, text, re.ASCII)
    digits, suffix = match.groups() if match else ("nan", "")
    number, suffix = float(digits), suffix.lower()
    if not math.isfinite(number) or (suffix and suffix not in MICROMETRES):
        units = "/".join(MICROMETRES)
        raise ValueError(f"{text!r} is not a length: a number >= 0, or one with {units}")
    return Length(number, suffix or None)


def unit_of(declared: str | None) -> str | None:
    """The unit that a scene declares, as it is typed; None if unknown or not declared."""
    name = (declared or "").strip().lower()
    if name.endswith(_OF_METRES):
        return _of_metres(name.removesuffix(_OF_METRES))
    name = _SYNONYMS.get(name, _SYNONYMS.get(name.removesuffix("s"), name))
    return name if name in MICROMETRES else None


def _of_metres(text: str) -> str | None:
    try:
        micrometres = float(text) * MICROMETRES["m"]
    except ValueError:
        return None
    known = (name for name, size in MICROMETRES.items() if abs(micrometres - size) <= _SAME * size)
    return next(known, None)


def ratio(unit: str, other: str) -> float:
    """How many of the other unit make one of this unit: exact, or rounded once."""
    return MICROMETRES[unit] / MICROMETRES[other]


def unit_in(unit: str, scale: float) -> str:
    """The unit for which `ratio(it, unit)` is `scale`."""
    return next(name for name in MICROMETRES if ratio(name, unit) == scale)


@lru_cache(maxsize=64)  # many bodies, few declarations
def stated_unit(declared: str | None) -> str | None:
    """The unit that a declaration is, or begins with: "mm", "Metres", "mm (assumed)"."""
    first = (declared or "").partition("(")[0].split()[:1]
    return unit_of(declared) or unit_of(first[0] if first else None)


def is_unit(declared: str) -> bool:
    """Whether a declaration begins with a unit."""
    first = declared.partition("(")[0].split()[:1]
    return bool(first) and unit_of(first[0]) is not None
