"""Why an input, or a part of it, cannot be used. Codes are those of `issue.CODES`."""

from __future__ import annotations

from satcheck.core.errors import SatcheckError


class Refused(SatcheckError):
    """A file, a mesh of it or an element of it is refused. What is beside it is not affected,
    unless it has no meaning without it, as the bodies of a scene file.

    line: the line of the file at fault; None: no single line, or the message states it.
    """

    def __init__(
        self,
        code: str,
        message: str,
        *,
        file: str | None = None,
        body: str | None = None,
        line: int | None = None,
    ) -> None:
        super().__init__(code, message, file=file, body=body)
        self.line = line

    @property
    def with_line(self) -> str:
        """The message, after its line."""
        return self.message if self.line is None else f"line {self.line}: {self.message}"

    def __str__(self) -> str:
        if self.line is None:
            return super().__str__()
        return f"{self.file}:{self.line}: {self.message}"
