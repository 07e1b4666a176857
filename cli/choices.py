"""The values and the defaults of the options of a check.

The settings of the library say the same, and a test holds them together: help must not load them.
"""

from __future__ import annotations

PLANES = ("xy", "yz", "xz")
ACCURACIES = ("aabb", "obb", "hull", "parts", "exact")
ACCURACY = "exact"
FAIL_ON = ("error", "warning", "note")
LEAST_SEVERITY = "error"
DEPTH_WIDTH = 0.01
DEPTH_BUDGET = 2.0
MOST_BUDGET = 86400
UNITS = ("um", "mm", "cm", "m", "in", "ft")
