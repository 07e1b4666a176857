"""satcheck.cli: the command. It writes one document to standard output, and messages to stderr."""

from __future__ import annotations

import gc
import sys

__all__ = ["main"]


def main() -> None:
    """The process of the command `satcheck`: parses sys.argv and exits."""
    # Start-up makes many objects and next to no garbage: looking for cycles meanwhile is 6 % of it.
    # commands.check turns the collector on again for anything but a small check.
    gc.disable()
    from satcheck.cli import exit_codes

    try:
        from satcheck.cli.entry import main as run
    except KeyboardInterrupt:
        sys.exit(exit_codes.INTERRUPTED)
    run()
