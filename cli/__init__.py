"""satcheck.cli: the command. It writes one document to standard output, and messages to stderr."""

from __future__ import annotations

import gc
import sys

__all__ = ["main"]

# Objects made between two searches for cycles: of what a command makes almost none is in one, and
# at the usual number the searches are 6 % of a small check.
COLLECT_AFTER = 1_000_000


def main() -> None:
    """The process of the command `satcheck`: parses sys.argv and exits."""
    gc.set_threshold(COLLECT_AFTER)
    from satcheck.cli import exit_codes

    try:
        from satcheck.cli.entry import main as run
    except KeyboardInterrupt:
        sys.exit(exit_codes.INTERRUPTED)
    run()
