"""`satcheck cache`: what the cache of convex parts holds, and emptying it."""

from __future__ import annotations

from satcheck.cli.report.words import counted


def describe() -> str:
    """Where the cache is, its entries and its size."""
    from satcheck.decompose import Cache

    held = Cache().info()
    return f"{held.path}\n{counted(held.entries, 'entry', 'entries')}, {_size(held.bytes)}"


def clear() -> str:
    """Delete every entry; says how many there were."""
    from satcheck.decompose import Cache

    return f"deleted {counted(Cache().clear(), 'entry', 'entries')}"


def _size(count: int) -> str:
    size = float(count)
    for unit in ("bytes", "KiB", "MiB"):
        if size < 1024:
            return f"{size:.4g} {unit}"
        size /= 1024
    return f"{size:.4g} GiB"
