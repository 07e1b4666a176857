"""Units of length. A scene declares one to label its lengths; nothing in a file is converted."""

from __future__ import annotations

import math
import re

from satcheck.core.frozen import frozen

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
# Few calls need it: compiled at its first use.
_LENGTH = r"\s*(\+?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?)\s*([a-zA-Z]*)\s*"


@frozen
class Length:
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
    found = re.fullmatch(_LENGTH, text, re.ASCII)
    digits, suffix = found.groups() if found else ("nan", "")
    number, suffix = float(digits), suffix.lower()
    if not math.isfinite(number) or (suffix and suffix not in MICROMETRES):
        units = "/".join(MICROMETRES)
        raise ValueError(f"{text!r} is not a length: a number >= 0, or one with {units}")
    return Length(number, suffix or None)


def unit_of(declared: str | None) -> str | None:
    """The unit that a scene declares, as it is typed; None if unknown or not declared."""
    name = (declared or "").strip().lower()
    name = _SYNONYMS.get(name, _SYNONYMS.get(name.removesuffix("s"), name))
    return name if name in MICROMETRES else None


def is_unit(declared: str) -> bool:
    """Whether a declaration begins with a unit: "mm", "Metres", "mm (assumed)"."""
    first = declared.partition("(")[0].split()[:1]
    return bool(first) and unit_of(first[0]) is not None
