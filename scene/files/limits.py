"""Limits of what a file makes. Each guards against small files that become huge. `access.py`
has those of sizes."""

from __future__ import annotations

from satcheck.scene.errors import Refused

BYTES_PER_MEGABYTE = 1 << 20

# Instances multiply: a dozen nested components can expand to 10^12 instances or triangles.
MAX_PLACEMENTS = 200_000
MAX_TRIANGLES = 50_000_000
MAX_VERTICES = 3 * MAX_TRIANGLES
MAX_WITHOUT_DATA = 100_000  # elements of accessors of glTF that the file does not hold
# Indices of glTF may name the data of their file so many times over, and more of them in any case.
MAX_REPEATED, ANY_REPEATED = 4, BYTES_PER_MEGABYTE // 4
MAX_DEPTH = 200  # of elements in XML and keys in TOML; no program nests deeper

# Our own code reads glTF and checks every range. Its JSON can cost a few tens of times its size.
# Up to this size a child process would only cost time.
IN_PROCESS_BYTES = 4 * BYTES_PER_MEGABYTE
# What such a file may cost in this process: files that it names, data that it unpacks, and numbers
# that it names again and again. Beyond that a child process reads it.
IN_PROCESS_WORK = 256 * BYTES_PER_MEGABYTE


def refuse_many(count: int, what: str) -> None:
    """Raises Refused for more placed parts than a file may have."""
    if count > MAX_PLACEMENTS:
        raise Refused("too-large", f"more than {MAX_PLACEMENTS} {what}: split the file")
