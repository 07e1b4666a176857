"""Warnings about files that several bodies share: each is given once."""

from __future__ import annotations

from collections.abc import Sequence

from msgspec.structs import replace

from satcheck.scene.bodies import Body
from satcheck.scene.issue import Issue


def issues_of_files(bodies: Sequence[Body]) -> list[Issue]:
    """Each file's warnings once: with the body's id where only one body uses the file."""
    users: dict[tuple[str, str | None], list[Body]] = {}
    for body in bodies:
        users.setdefault((body.file.path, body.file.part), []).append(body)
    return [
        _shared(found, together) for together in users.values() for found in together[0].file.issues
    ]


def _shared(found: Issue, bodies: list[Body]) -> Issue:
    part, message = bodies[0].file.part, found.message
    if len(bodies) == 1:
        return replace(found, body=bodies[0].id)
    return found if part is None else replace(found, message=f"mesh {part!r}: {message}")
