"""Numbers for people: six significant digits. The JSON report has all of them."""

from __future__ import annotations

import math

DIGITS = 6
# Relative. A bound this close to its six digits is shown as these: the last place of a float64
# computation is not worth a whole unit in the sixth digit.
ROUNDOFF = 1e-12


def number(value: float) -> str:
    """Rounded to nearest."""
    return f"{value + 0.0:.{DIGITS}g}"


def bounds(low: float, high: float) -> str:
    """A proven interval, rounded outward, so that what is shown is still true (to ROUNDOFF)."""
    shown = (_rounded(low, down=True), _rounded(high, down=False))
    return shown[0] if shown[0] == shown[1] else " .. ".join(shown)


def at_least(value: float) -> str:
    """A proven lower bound, rounded down (to ROUNDOFF)."""
    return _rounded(value, down=True)


def at_most(value: float) -> str:
    """A proven upper bound, rounded up (to ROUNDOFF)."""
    return _rounded(value, down=False)


def vector(values: tuple[float, float, float]) -> str:
    """Rounded relative to the longest component: no 1e-17 beside a 1."""
    return f"({', '.join(_components(values))})"


def after_rounding(values: tuple[float, float, float] | None) -> str:
    """` after rounding` where `vector` does not show the numbers themselves, else nothing."""
    if values is None or tuple(map(float, _components(values))) == values:
        return ""
    return " after rounding"


def _components(values: tuple[float, float, float]) -> list[str]:
    longest = max(abs(value) for value in values)
    if longest == 0:
        return ["0", "0", "0"]
    places = DIGITS - 1 - math.floor(math.log10(longest))
    return [number(round(value, places)) for value in values]


def duration(microseconds: float) -> str:
    """Three significant digits, in the unit that suits."""
    for limit, unit, factor in ((1e3, "us", 1.0), (1e6, "ms", 1e-3)):
        if microseconds < limit:
            return f"{microseconds * factor:.3g} {unit}"
    return f"{microseconds * 1e-6:.3g} s"


def _rounded(value: float, *, down: bool) -> str:
    text = number(value)
    outward = value - float(text) if down else float(text) - value
    if outward >= -ROUNDOFF * abs(value):
        return text
    step = 10.0 ** (math.floor(math.log10(abs(value))) - DIGITS + 1)
    return number(value - step if down else value + step)
