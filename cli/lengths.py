"""Lengths on the command line: `0.5` is in the units of the files, `5mm` needs declared units."""

from __future__ import annotations

import math
from dataclasses import dataclass

import click

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


@dataclass(frozen=True, slots=True)
class Length:
    """A length >= 0 as typed. unit None: in the units of the files."""

    value: float
    unit: str | None

    def in_units_of(self, declared: str | None, option: str) -> float:
        """This length in the declared units of the scene; click.UsageError if that is unknown."""
        if self.unit is None:
            return self.value
        known = unit_of(declared)
        if known is None:
            told = f"declare {declared!r}, which is unknown" if declared else "declare no units"
            raise click.UsageError(
                f"{option} {self.value:g}{self.unit}: the inputs {told}; "
                "give a plain number in the units of the files"
            )
        return self.value * MICROMETRES[self.unit] / MICROMETRES[known]


def unit_of(declared: str | None) -> str | None:
    """The unit that a scene declares, as it is typed here; None if unknown or not declared."""
    name = (declared or "").strip().lower()
    name = _SYNONYMS.get(name, _SYNONYMS.get(name.removesuffix("s"), name))
    return name if name in MICROMETRES else None


def length(text: str) -> Length:
    """A click parameter type; click.BadParameter for what is not a length."""
    digits = text.strip().rstrip("abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ")
    suffix = text.strip()[len(digits) :].lower()
    try:
        number = float(digits)
    except ValueError:
        number = math.nan
    if not (math.isfinite(number) and number >= 0) or (suffix and suffix not in MICROMETRES):
        units = "/".join(MICROMETRES)
        raise click.BadParameter(f"{text!r} is not a length: a number >= 0, or one with {units}")
    return Length(number, suffix or None)
