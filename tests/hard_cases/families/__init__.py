"""One module a category; each yields its cases from a seed."""

from __future__ import annotations

from tests.hard_cases.case import Family
from tests.hard_cases.families import (
    angles,
    contact,
    far,
    flats,
    gaps,
    large,
    redundant,
    sizes,
    slivers,
    symmetric,
)

FAMILIES: tuple[Family, ...] = (
    contact,
    gaps,
    angles,
    slivers,
    flats,
    redundant,
    symmetric,
    far,
    sizes,
    large,
)
