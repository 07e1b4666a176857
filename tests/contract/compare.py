"""Which changes of a fact break the contract.

Every fact has to stay as it is, except:
- Proven bounds may move inwards freely, and outwards by at most a twentieth of the old width. The
  new interval meets the old one, since both contain the true figure.
- A figure that was absent may appear, and so may its proof.
- The quality of a finding may rise. It may fall if a figure appears, because it is the weakest one.
- The bodies that `satcheck resolve` moves may move farther by a quarter, or less far.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Mapping
from typing import Any

OUTWARDS = 1 / 20
# A figure with bounds that are this close together, relative to it, counts as exact up to rounding
# (EXACT_WIDTH in report/judge.py): the quality of a depth is `exact` then. So exact figures may
# differ by as much and stay exact.
ROUNDING = 1e-9
LONGER = 1.25
FIGURES = ("depth", "thickness", "distance", "volume", "time_of_impact", "length", "area")
# What a report may state that it did not state before.
PROVEN = ("depth_proven", "mtv_proven", "thickness_proven")
MAY_APPEAR = (*FIGURES, *PROVEN, "exact_relation", "contacts", "components")
QUALITIES = ("estimate", "bounded", "exact")


def differences(old: Any, new: Any, where: str = "") -> list[str]:
    """Return what breaks the contract, each with its place."""
    if isinstance(old, Mapping) and isinstance(new, Mapping):
        return _of_tables(old, new, where)
    if isinstance(old, list) and isinstance(new, list):
        return _of_lists(old, new, where)
    return [] if _same(old, new) else [f"{where}: {old} became {new}"]


def _of_tables(old: Mapping[str, Any], new: Mapping[str, Any], where: str) -> list[str]:
    said = [f"{where}{key}: {old[key]} is lost" for key in old if key not in new]
    for key in new:
        place = f"{where}{key}"
        if key in old:
            rule = RULES.get(key)
            if rule is None:
                inner = f"{place}: " if isinstance(new[key], Mapping | list) else place
                said += differences(old[key], new[key], inner)
            elif problem := rule(old[key], new[key]):
                said.append(f"{place}: {problem}")
        elif key not in MAY_APPEAR and not (key == "mtv_verified" and new[key] is True):
            said.append(f"{place}: {new[key]} is new")
    if any(key in new and key not in old for key in FIGURES):
        said = [line for line in said if not line.startswith(f"{where}quality: ")]
    return said


def _of_lists(old: list[Any], new: list[Any], where: str) -> list[str]:
    """Lists of words are compared as such; lists of tables item by item."""
    words = not any(isinstance(item, Mapping) for item in [*old, *new])
    if words or len(old) != len(new):
        before, after = (Counter(map(str, items)) for items in (old, new))
        said = [f"{where}{item} is lost" for item in before - after]
        said += [f"{where}{item} is new" for item in after - before]
        return said if said or old == new else [f"{where}{old} became {new}"]
    pairs = enumerate(zip(old, new, strict=True), start=1)
    return [line for n, (a, b) in pairs for line in differences(a, b, f"{where}{n}: ")]


def bounds_problem(old: list[float], new: list[float]) -> str | None:
    """Return why an interval of a figure may not replace an older one; None: it may."""
    (low, high), (lower, upper) = old, new
    rounding = ROUNDING * max(abs(low), abs(high))
    outwards = max(OUTWARDS * (high - low), rounding)
    if lower > upper:
        return f"{new} is no interval"
    if lower > high + rounding or upper < low - rounding:
        return f"{new} does not meet {old}"
    if lower < low - outwards or upper > high + outwards:
        return f"{new} is wider than {old} by more than a twentieth"
    return None


def quality_problem(old: str, new: str) -> str | None:
    fell = QUALITIES.index(new) < QUALITIES.index(old)
    return f"{old} became {new}" if fell else None


def motion_problem(old: float, new: float) -> str | None:
    return f"{new} is much longer than {old}" if new > LONGER * old else None


def _same(old: Any, new: Any) -> bool:
    return type(old) is type(new) and bool(old == new)


RULES: dict[str, Callable[[Any, Any], str | None]] = {
    **dict.fromkeys(FIGURES, bounds_problem),
    "quality": quality_problem,
    "total_motion": motion_problem,
}
