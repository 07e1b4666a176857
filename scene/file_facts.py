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
        _shared(issue, together) for together in users.values() for issue in together[0].file.issues
    ]


def _shared(issue: Issue, bodies: list[Body]) -> Issue:
    part, message = bodies[0].file.part, issue.message
    if len(bodies) == 1:
        return replace(issue, body=bodies[0].id)
    return issue if part is None else replace(issue, message=f"mesh {part!r}: {message}")
