"""The one place that writes: the document to standard output, everything else to stderr."""

from __future__ import annotations

import contextlib
import errno
import os
import re
import sys
from collections.abc import Callable, Iterable
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple, TextIO

import click

from satcheck.report.atomic_file import last_link, replace_file

if TYPE_CHECKING:
    from satcheck.report.report import Issue
    from satcheck.scene import Issue as InputIssue

# Where neither COLUMNS nor a terminal sets a width.
PIPE_WIDTH = 120
# A reader that left early: EPIPE, and EINVAL as Windows calls it.
_READER_LEFT = (errno.EPIPE, errno.EINVAL)
_STANDARD_OUTPUT = ("/dev/stdout", "/dev/fd/1", "/proc/self/fd/1")
# What becomes of the bytes of a file name that are no text.
_UNDECODABLE = "backslashreplace"
# ::error of GitHub Actions begins a line; ##[error], and ##vso[task] of Azure, may stand anywhere.
_COMMAND = re.compile(r"^\s*::|##+(?=\w*\[)")
_COLOUR = re.compile(r"(\x1b\[[0-9;]*m)")


class Page(NamedTuple):
    """What the reader of a table can show."""

    width: int
    colour: bool
    unicode: bool


PLAIN_PAGE = Page(width=PIPE_WIDTH, colour=False, unicode=True)
# A document as it is drawn for a page: one text or its pieces.
Render = Callable[[Page], str | bytes | Iterable[str]]


def talk(line: str) -> None:
    """One line to stderr; a reader that has left is no error."""
    if sys.stderr is None:
        return
    encoding = sys.stderr.encoding or "ascii"
    line = "\n".join(map(harmless, line.split("\n")))
    with contextlib.suppress(OSError, ValueError):
        sys.stderr.write(line.encode(encoding, "backslashreplace").decode(encoding) + "\n")
        sys.stderr.flush()


def tell_issues(issues: Iterable[Issue | InputIssue]) -> None:
    """A line to stderr for each."""
    for issue in issues:
        talk(f"satcheck: {issue_line(issue)}")


def cannot_write(where: str, reason: str | None) -> click.ClickException:
    """The document could not be delivered. To be raised."""
    return click.ClickException(f"{where}: cannot write: {reason} [cannot-write]")


class Document:
    """Standard output, kept for one document.

    From construction on, file descriptor 1 leads to stderr: what a third party prints, from Python
    or from native code, now or at exit, cannot get between the lines of the document.
    """

    def __init__(self) -> None:
        self._stream: TextIO | None = None
        self.page = PLAIN_PAGE
        self.is_begun = False
        if sys.stdout is None:
            return
        self.page = _page(sys.stdout)
        encoding = sys.stdout.encoding or "utf-8"
        try:
            sys.stdout.flush()
            kept = os.dup(sys.stdout.fileno())
            os.dup2(_talk_descriptor(), sys.stdout.fileno())
        except (OSError, ValueError):  # not backed by a descriptor: nothing to keep apart
            self._stream = sys.stdout
            return
        self._stream = os.fdopen(kept, "w", encoding=encoding, errors="replace", newline="")

    def deliver(self, render: Render, output: Path | None, *, utf8: bool = False) -> None:
        """Write what `render` makes of a page: to the file, plain, or else to standard output."""
        if output is None or _is_standard_output(output):
            self.write(render(self.page), utf8=utf8)
        else:
            write_file(output, render(PLAIN_PAGE))

    def write(self, text: str | bytes | Iterable[str], *, utf8: bool = False) -> None:
        """Write it all: bytes, one text, or its pieces.

        A closed pipe is silent, any other failure is cannot_write().

        utf8: whatever the terminal's encoding (JSON is UTF-8 by definition); lone surrogates of
        undecodable file names become their `\\udcXX` escapes, which JSON reads back.
        """
        if self._stream is None:
            if utf8:  # a program waits for it; of a table the exit code is left
                raise cannot_write("standard output", "it is closed")
            return
        if utf8 and hasattr(self._stream, "reconfigure"):
            self._stream.reconfigure(encoding="utf-8", errors=_UNDECODABLE)
        self.is_begun = True
        try:
            if isinstance(text, bytes):
                self._stream.buffer.write(text)
            else:
                self._stream.writelines(_pieces(text))
            self._stream.flush()
        except OSError as error:
            abandon(self._stream)
            if error.errno not in _READER_LEFT:
                raise cannot_write("standard output", error.strerror) from None


def harmless(line: str, *, colour: bool = False) -> str:
    """A line without what a terminal or a CI system obeys instead of showing it, colours aside
    where they are wanted: names of bodies and files can hold any character, and must not rewrite a
    verdict."""
    if "##" in line or "::" in line:
        line = _COMMAND.sub(lambda match: " ".join(match[0]), line)
    if line.isprintable():
        return line
    pieces = _COLOUR.split(line) if colour else [line]
    return "".join(
        piece
        if number % 2
        else "".join(c if c.isprintable() else "\N{REPLACEMENT CHARACTER}" for c in piece)
        for number, piece in enumerate(pieces)
    )


def write_file(path: Path, content: bytes | str | Iterable[str]) -> None:
    """Replace a file as a whole: by bytes, by one text or its pieces, in UTF-8; cannot_write()
    where that fails, and the file is then what it was."""
    try:
        if isinstance(content, bytes):
            replace_file(path, (content,))
        else:
            replace_file(path, (text.encode(errors=_UNDECODABLE) for text in _pieces(content)))
    except OSError as error:
        raise cannot_write(str(path), error.strerror) from None


def _pieces(text: str | Iterable[str]) -> Iterable[str]:
    return (text,) if isinstance(text, str) else text


def abandon(stream: TextIO) -> None:
    """Throw away what is still buffered, or the interpreter complains about it at exit."""
    with contextlib.suppress(OSError):
        os.dup2(os.open(os.devnull, os.O_WRONLY), stream.fileno())


def _is_standard_output(path: Path) -> bool:
    """By its name: where the descriptor of that leads is not where documents go."""
    try:
        if not path.is_symlink() and "fd" not in path.parts:
            return False
        return str(last_link(path)) in _STANDARD_OUTPUT
    except OSError:  # the attempt to write says why
        return False


def _talk_descriptor() -> int:
    try:
        os.fstat(2)
    except OSError:
        return os.open(os.devnull, os.O_WRONLY)
    return 2


def _columns(stream: TextIO) -> int:
    """Return COLUMNS, or else the width of the terminal. shutil does so, but is slow to import."""
    columns = os.environ.get("COLUMNS", "")
    if columns.isdecimal() and int(columns):
        return int(columns)
    try:
        return os.get_terminal_size(stream.fileno()).columns or PIPE_WIDTH
    except (OSError, ValueError):
        return PIPE_WIDTH


def _wants_colour(terminal: bool) -> bool:
    """--color decides, then NO_COLOR and FORCE_COLOR (https://no-color.org and
    https://force-color.org: any value that is not empty), then whether it is a terminal."""
    context = click.get_current_context(silent=True)
    if context is not None and context.color is not None:
        return context.color
    if os.environ.get("NO_COLOR"):
        return False
    if os.environ.get("FORCE_COLOR"):
        return True
    return terminal and os.environ.get("TERM") != "dumb"


def _page(stream: TextIO) -> Page:
    terminal = stream.isatty()
    encoding = (stream.encoding or "").lower().replace("-", "").replace("_", "")
    return Page(
        width=_columns(stream),
        colour=_wants_colour(terminal),
        unicode=encoding.startswith("utf"),
    )


def issue_line(issue: Issue | InputIssue) -> str:
    """`warning: l_bracket: 2 open edges [open-mesh]`, as it also goes to stderr; one line, whatever
    the names are."""
    return harmless(f"{issue.severity}: {with_place(issue)} [{issue.code}]")


def with_place(issue: Issue | InputIssue) -> str:
    """Return the message, with its body or file in front if it begins with neither."""
    body, file = issue.body or "", issue.file or ""
    begins = body and issue.message.startswith((f"{body}:", f"{body} is ", f"{body} and "))
    if begins or not (body or file) or (file and issue.message.startswith(file)):
        return issue.message
    return f"{body or file}: {issue.message}"
