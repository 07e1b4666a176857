"""Rewrite the golden reports, and say which changed."""

from __future__ import annotations

import sys

from tests.golden import SAMPLE_CALLS, golden_file, report


def main() -> None:
    for name in SAMPLE_CALLS:
        file = golden_file(name)
        _, document = report(name)
        before = file.read_bytes() if file.exists() else b""
        file.write_bytes(document)
        sys.stdout.write(f"{name}: {'same' if before == document else 'CHANGED'}\n")


if __name__ == "__main__":
    main()
