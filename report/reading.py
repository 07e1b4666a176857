"""How the files of a report were read, where their format leaves a choice."""

from __future__ import annotations

from satcheck.report.values import Value


class StatedReading(Value, frozen=True, kw_only=True):
    """The options that count for the formats of these files; None: no such file, or the default.

    time: of animations, in seconds; None: the pose that the file stores.
    """

    time: float | None = None
