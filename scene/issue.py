"""What is worth saying about an input: one coded, placed sentence each."""

from __future__ import annotations

from msgspec import Struct

from satcheck.scene.codes import CODES, Severity


class Issue(Struct, frozen=True):
    """A finding about an input. `code` is one of `codes.CODES` and decides the severity.

    body: id of the body concerned; file: path as given. Either may be None.
    """

    code: str
    severity: Severity
    body: str | None
    file: str | None
    message: str


def issue(code: str, message: str, *, body: str | None = None, file: str | None = None) -> Issue:
    """An Issue with the severity that the catalogue gives its code."""
    return Issue(code, CODES[code].severity, body, file, message)
