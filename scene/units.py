"""Units of length: names and conversion factors."""

from __future__ import annotations

import math
import re
from functools import lru_cache

from msgspec import Struct

# Micrometres in one unit. They are whole numbers, so that a conversion rounds once.
MICROMETRES = {"um": 1, "mm": 1_000, "cm": 10_000, "m": 1_000_000, "in": 25_400, "ft": 304_800}
RESCALED = "meters (rescaled)"  # its reader has turned a unit without a name into metres
_SYNONYMS = {
    RESCALED: "m",
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
# The COLLADA reader states the unit of a file as "0.0254 * meters".
_OF_METRES = " * meters"
_SAME = 1e-9  # relative: a factor written with few digits still means the unit
# Few calls need it: compiled at its first use. Also for JSON Schema, so without flags.
_BLANK = r"[ \t\n\r\f\v]*"
_UNIT = "|".join("".join(f"[{c}{c.upper()}]" for c in unit) for unit in MICROMETRES)
_NUMBER = r"[+]?(?:[0-9]+[.]?[0-9]*|[.][0-9]+)(?:[eE][+-]?[0-9]+)?"
LENGTH_PATTERN = f"^{_BLANK}({_NUMBER}){_BLANK}({_UNIT})?{_BLANK}$"


class Length(Struct, frozen=True):
    """A length >= 0 as written. unit: None: the unit of the files."""

    value: float
    unit: str | None

    def __str__(self) -> str:
        return f"{self.value:g}{self.unit or ''}"

    def in_units_of(self, declared: str | None) -> float:
        """This length in the declared units of a scene. Raises ValueError if they are unknown."""
        if self.unit is None:
            return self.value
        known = unit_of(declared)
        if known is None:
            why = f"{declared!r} is not a known unit" if declared else "no units are declared"
            raise ValueError(f"{self}: {why}, so give a plain number")
        return self.value * MICROMETRES[self.unit] / MICROMETRES[known]


def parse_length(text: str) -> Length:
    """Parses `0.5` or `2mm`. Raises ValueError if the text is not a length."""
    match = re.fullmatch(LENGTH_PATTERN, text)
    number = float(match[1]) if match else math.nan
    if match is None or not math.isfinite(number):
        units = "/".join(MICROMETRES)
        raise ValueError(f"{text!r} is not a length: a number >= 0, or one with {units}")
    return Length(number, match[2].lower() if match[2] else None)


def unit_of(declared: str | None) -> str | None:
    """The unit that a scene declares, as a key of MICROMETRES; None if unknown or not declared."""
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
    """The number of `other` units in one `unit`: exact, or rounded once."""
    return MICROMETRES[unit] / MICROMETRES[other]


def unit_in(unit: str, scale: float) -> str:
    """The unit X for which `ratio(X, unit)` is `scale`."""
    return next(name for name in MICROMETRES if ratio(name, unit) == scale)


@lru_cache(maxsize=64)  # many bodies share few declarations
def stated_unit(declared: str | None) -> str | None:
    """The unit at the start of a declaration such as "mm", "Metres", "mm (assumed)"."""
    first = (declared or "").partition("(")[0].split()[:1]
    return unit_of(declared) or unit_of(first[0] if first else None)


def is_unit(declared: str) -> bool:
    """Whether a declaration begins with a unit."""
    first = declared.partition("(")[0].split()[:1]
    return bool(first) and unit_of(first[0]) is not None
