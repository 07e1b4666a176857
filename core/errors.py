"""The base class of all exceptions of satcheck: a stable code and a message for people."""

from __future__ import annotations


class SatcheckError(Exception):
    """satcheck could not do what was requested.

    `code` is kebab-case and stable: scripts may rely on it. `message` says what happened, where,
    and what to do about it. `file` and `body` name the place of the error, if there is one;
    `str(error)` starts with them. `others`: further errors, if this one is the first of several.
    """

    def __init__(
        self, code: str, message: str, *, file: str | None = None, body: str | None = None
    ) -> None:
        super().__init__(code, message)
        self.code = code
        self.message = message
        self.file = file
        self.body = body
        self.others: tuple[SatcheckError, ...] = ()

    def __str__(self) -> str:
        where = [self.file] if self.file else []
        if self.body:
            where.append(f"body {self.body!r}")
        return ": ".join([*where, self.message])

    def __reduce__(self) -> tuple[object, ...]:
        return _rebuild, (type(self), self.code, self.message, self.file, self.body)


def _rebuild(
    kind: type[SatcheckError], code: str, message: str, file: str | None, body: str | None
) -> SatcheckError:
    return kind(code, message, file=file, body=body)
