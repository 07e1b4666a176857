"""The sub-commands, a file each: `command` in the module of its name is the click command."""

from __future__ import annotations

# What each does, for the help of satcheck: that must not import them all. The first sentence of the
# help of each command says the same.
COMMANDS = {
    "axes": "Show why two convex bodies are apart: the separating axis theorem, axis by axis.",
    "baseline": "Known findings that do not fail a check.",
    "batch": "Check thousands of scenes: none stops the others.",
    "config": "The config file: show which options are in effect.",
    "decompose": "Split meshes into convex parts, for physics engines.",
    "each": "Check each asset of a folder as a scene of its own.",
    "report": "Report which scenes of a batch fail, and how.",
    "resolve": "Move the bodies of a scene apart, by short translations.",
    "schema": "Print the JSON Schema of a kind of document.",
    "suggest": "Suggest which pairs a scene may allow to overlap.",
    "tradeoff": "What accuracy costs in time: every rung of the ladder on one pair.",
    "verify": "Re-check the certificates of a report.",
    "view": "Show a report in 3-D, from its mesh files.",
}
