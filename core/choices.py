"""What a check can be told, and what holds where nobody says: for the command line, which must not
load the rest to show its help, and for the settings of a check."""

from __future__ import annotations

from typing import Literal

Accuracy = Literal["aabb", "obb", "hull", "parts", "exact"]
ACCURACIES: tuple[Accuracy, ...] = ("aabb", "obb", "hull", "parts", "exact")
ACCURACY: Accuracy = "exact"

FailOn = Literal["error", "warning", "note"]
FAIL_ON: tuple[FailOn, ...] = ("error", "warning", "note")
LEAST_SEVERITY: FailOn = "error"

# Relative width of the depth interval of a concave pair below which nothing finer is asked for.
DEPTH_WIDTH = 0.01
# Seconds, in work units of a slow machine, that narrowing the interval of one pair may take.
DEPTH_BUDGET = 2.0
MOST_BUDGET = 86400
