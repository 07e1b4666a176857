"""Options of a check that contradict each other. Each function raises click.UsageError."""

from __future__ import annotations

from typing import Any

import click

from satcheck.cli.formats.registry import kind_of
from satcheck.cli.inputs import Inputs


def refuse_certificate(form: str, *, wanted: bool) -> None:
    if wanted and form != "json":
        raise click.UsageError(
            "--certificate needs a JSON report: add -o report.json or --format json"
        )


def refuse_of_poses(form: str, **options: Any) -> None:
    """Of many poses a report has counts and no evidence."""
    if kind_of(form) != "plain":
        raise click.UsageError(f"--format {form} takes one pose, and several are given")
    for name in ("baseline", "certificate", "explain", "cross_check", "png", "glb"):
        if options.get(name):
            option = name.replace("_", "-")
            raise click.UsageError(f"--{option} takes one pose, and several are given")


def refuse_of_worlds(form: str, inputs: Inputs, **options: Any) -> None:
    """What is about one world."""
    refused = {f"--format {form}": kind_of(form) == "picture", "poses": inputs.has_poses}
    refused |= {f"--{name}": bool(options[name]) for name in ("certificate", "explain")}
    refused |= {f"--{name}": name in options for name in ("png", "glb")}
    for what in (what for what, given in refused.items() if given):
        raise click.UsageError(
            f"each scene is a world of its own, and {what} is about one: give one scene, or --merge"
        )
