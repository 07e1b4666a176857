"""The headings under which the help of a command lists its options: one table for all commands."""

from __future__ import annotations

import re
from collections.abc import Sequence

import click

# Help with fewer options has no headings.
MANY = 15
OTHER = "Other options"
# The range of a number, as click writes it: ` [x>=1]`, `; 0<x<1`.
_RANGE = re.compile(r"\s*\[[^\]\s]*x[<>][^\]]*\]|; [^;\[\]]*x[<>][^\]]*(?=\])")
# The names of the parameters, in the order of the help.
SECTIONS = {
    "What to check": "bodies pairs manifest shard exclude changed_since split merge planar units "
    "allow_open package packages geometry purpose time mesh_hulls pose state "
    "joint_path sample seed root allow_outside",
    "What to compute": "depth contacts components volume never cross_check certificate",
    "Tolerances and rules": "clearance tolerance surface_tolerance chord_tolerance "
    "angular_tolerance rules between baseline fail_on accept exit_zero pins",
    "Output": "output parts_out resume form png glb folder scene_out plot dark top explain timings "
    "quiet color",
    "Accuracy and limits": "accuracy method threshold depth_width depth_budget thickness_width "
    "max_motion iterations repeat budget seconds seconds_per_file megabytes_per_file "
    "scene_seconds scene_megabytes engine scheduler jobs cache",
}


def brief(record: tuple[str, str]) -> tuple[str, str]:
    """Without the range of a number: a message states it where it matters."""
    option, text = record
    return option, _RANGE.sub("", text)


def sections(options: Sequence[click.Option]) -> dict[str, list[click.Option]]:
    """The options under their headings; what has none comes last."""
    by_name = {option.name: option for option in options}
    made = {
        heading: [by_name.pop(name) for name in names.split() if name in by_name]
        for heading, names in SECTIONS.items()
    }
    made[OTHER] = list(by_name.values())
    return {heading: chosen for heading, chosen in made.items() if chosen}
