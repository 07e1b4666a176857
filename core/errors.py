"""The one exception family of satcheck: a stable code, and a message a person can act on."""

from __future__ import annotations


class SatcheckError(Exception):
    """Something satcheck was asked to do could not be done.

    `code` is kebab-case and stable: scripts may rely on it. `message` says what happened, where,
    and what to do about it. `file` and `body` name the culprit where there is one; `str(error)`
    starts with them. `others`: what else is wrong, where one error stands for several.
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
