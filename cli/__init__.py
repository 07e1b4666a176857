"""satcheck.cli: the command. Options in, one document on standard output, the talk on stderr."""

from __future__ import annotations

from satcheck.cli.entry import main

__all__ = ["main"]
