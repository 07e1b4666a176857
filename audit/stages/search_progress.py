"""How far the search of a figure is, for whoever waits for a pair that takes long."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING

from satcheck.core.steps import step_in_words

if TYPE_CHECKING:
    from satcheck.audit.pair import Pair


@contextmanager
def shown(figure: str, pair: Pair) -> Iterator[Callable[[float, float, float], None]]:
    """`depth of kettle and snowflake: 0.488 to 0.51, 12 % of the budget`, while it lasts. Gives
    what a search of the core calls with its interval and the share of its budget that is spent."""
    with step_in_words() as say:

        def progress(lower: float, upper: float, share: float) -> None:
            interval = f"{max(lower, 0.0):.3g} to {max(upper, 0.0):.3g}"
            spent = f"{100 * share:.0f} % of the budget"
            say(f"{figure} of {pair.a.id} and {pair.b.id}: {interval}, {spent}")

        yield progress
