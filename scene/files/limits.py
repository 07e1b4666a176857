"""Limits of what a file makes. Each guards against small files that become huge. `access.py`
has those of sizes."""

from __future__ import annotations

from satcheck.scene.errors import Refused

BYTES_PER_MEGABYTE = 1 << 20

# Instances multiply: a dozen nested components can expand to 10^12 instances or triangles.
MAX_PLACEMENTS = 200_000
# The same for bodies: so many, and one more for so many bytes of the file, as a placement takes.
ANY_BODIES, BYTES_OF_BODY = 50_000, 8
MAX_TRIANGLES = 50_000_000
MAX_VERTICES = 3 * MAX_TRIANGLES
# Of one body of many instances: so many triangles, and so many times those of all its meshes.
ANY_COPIED, MAX_COPIES = 1_000_000, 1_000
MAX_WITHOUT_DATA = 100_000  # elements of accessors of glTF that the file does not hold
# Indices of glTF may name the data of their file so many times over, and more of them in any case.
MAX_REPEATED, ANY_REPEATED = 4, BYTES_PER_MEGABYTE // 4
# A part of a zip may unpack to so much, and to so many times its packed size. Meshes shrink to a
# tenth.
ANY_UNPACKED, MAX_UNPACKED = 8 * BYTES_PER_MEGABYTE, 100
MAX_DEPTH = 200  # of elements in XML and keys in TOML; no program nests deeper

# Our own code reads glTF and checks every range. Its JSON can cost a few tens of times its size.
# Up to this size a child process would only cost time.
IN_PROCESS_BYTES = 4 * BYTES_PER_MEGABYTE
# What such a file may cost in this process: files that it names, data that it unpacks, and numbers
# that it names again and again. Beyond that a child process reads it.
IN_PROCESS_WORK = 256 * BYTES_PER_MEGABYTE


def refuse_many(count: int, what: str, most: int | None = None) -> None:
    """Raises Refused for more placed parts than a file may have."""
    most = MAX_PLACEMENTS if most is None else min(most, MAX_PLACEMENTS)
    if count > most:
        raise Refused("too-large", f"more than {most} {what}: split the file")
