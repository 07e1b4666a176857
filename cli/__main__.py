"""`python -m satcheck.cli` is the command `satcheck`."""

from __future__ import annotations

from satcheck.cli import main

if __name__ == "__main__":
    main()
