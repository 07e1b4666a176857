"""Issues that block a pass, and those of them that the user accepts by name.

What a file holds and nobody reads may be a body, or move one. Such an issue leaves the check
incomplete, until somebody says that it is meant to be so: by its code, and the file or body.
"""

from __future__ import annotations

from collections.abc import Iterable
from fnmatch import fnmatchcase
from glob import escape
from pathlib import PurePath

from msgspec import Struct
from msgspec.structs import replace

from satcheck.core.errors import SatcheckError
from satcheck.report.report import Issue
from satcheck.scene.bodies import Accepted
from satcheck.scene.issue import BLOCKING, CODES
from satcheck.scene.words import meant, with_closed_brackets

# The code of an issue about an acceptance that accepts nothing.
UNUSED_ACCEPTANCE = "unused-acceptance"


class Acceptance(Struct, frozen=True):
    """code: of issues; name: a pattern of the file, with or without its folders, or of the body."""

    code: str
    name: str = "*"

    def accepts(self, issue: Issue) -> bool:
        names = [issue.body or "", issue.file or "", PurePath(issue.file or "").name]
        glob = with_closed_brackets(self.name)
        return issue.code == self.code and any(fnmatchcase(name, glob) for name in names)


def acceptance(text: str) -> Acceptance:
    """Return what `CODE` or `CODE:NAME` accepts. Raises SatcheckError for a code that blocks
    nothing."""
    code, colon, name = text.partition(":")
    if code in CODES and CODES[code].severity == "error":
        message = f"{code} is an error, which is not accepted: mend the file, or leave it out"
        raise SatcheckError("bad-acceptance", message)
    if code not in BLOCKING:
        hint = meant(code, BLOCKING, "; did you mean {}?") or f"; these do: {', '.join(BLOCKING)}"
        named = f". A name follows a code: unread-file:{text}" if "." in text else ""
        message = f"no issue of the code {code!r} blocks a pass{hint}{named}"
        raise SatcheckError("bad-acceptance", message)
    if colon and not name:
        message = f"{text!r} names no file and no body; {code!r} alone accepts all of this code"
        raise SatcheckError("bad-acceptance", message)
    return Acceptance(code, name or "*")


def with_states(issues: Iterable[Issue], accepted: Iterable[Accepted]) -> list[Issue]:
    """Return the issues with their states, and one for each acceptance that accepts nothing."""
    known = {each: acceptance(each.text) for each in accepted}
    used: set[str] = set()
    judged = []
    for issue in issues:
        if issue.code in BLOCKING:
            place = {issue.file, issue.body}
            by = {
                each.text
                for each, words in known.items()
                if words.accepts(issue) and not (each.about and place.isdisjoint(each.about))
            }
            used |= by
            judged.append(replace(issue, state="accepted" if by else "blocking"))
        else:
            judged.append(issue)
    for text in dict.fromkeys(each.text for each in known):
        if text not in used:
            message = f'nothing is accepted by "{text}": no such issue'
            judged.append(Issue(UNUSED_ACCEPTANCE, "warning", None, None, message))
    return judged


def words_to_accept(issue: Issue) -> str:
    """Return the option that accepts the issue."""
    name = escape(issue.body or PurePath(issue.file or "").name)
    return f"--accept {issue.code}:{name}" if name else f"--accept {issue.code}"
