"""What a scene may say though it is of no use: worth a warning."""

from __future__ import annotations

from collections.abc import Iterable

from satcheck.scene.format.entries import BodyEntry
from satcheck.scene.format.values import meant
from satcheck.scene.issue import Issue, issue
from satcheck.scene.units import is_unit


def unknown_units(units: str | None, path: str) -> list[Issue]:
    if units is None or is_unit(units):
        return []
    message = f"unknown units {units!r}: lengths are plain numbers"
    return [issue("unknown-units", message, file=path)]


def unknown_groups(ignored: frozenset[str], bodies: Iterable[BodyEntry], path: str) -> list[Issue]:
    groups = {group for body in bodies for group in body.groups}
    return [
        issue(
            "unknown-group",
            f"no body is in group {group!r} of ignore_within_groups{meant(group, groups)}",
            file=path,
        )
        for group in sorted(ignored - groups)
    ]
