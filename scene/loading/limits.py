"""Limits of a file. Each guards against small files that become huge."""

from __future__ import annotations

BYTES_PER_MEGABYTE = 1 << 20

# A reader needs up to about three times a text file's size, so a file may take this share of the
# memory limit.
FILE_SHARE_OF_MEMORY = 4

# Instances multiply: a dozen nested components can promise 10^12 of them, or of their triangles.
MAX_PLACEMENTS = 1_000_000
MAX_TRIANGLES = 50_000_000

# XML compresses about 4:1 to 20:1; a part that unpacks further than this, to more than a few
# megabytes, is filler.
MAX_INFLATION = 200
SMALL_PART_BYTES = 8 * BYTES_PER_MEGABYTE
MAX_PART_BYTES = 1024 * BYTES_PER_MEGABYTE

# glTF is read by our own code, every range checked; what its JSON can cost is a few tens of times
# its size, so up to here a child process would only cost time.
IN_PROCESS_BYTES = 4 * BYTES_PER_MEGABYTE

# glTF data that takes next to no room in the file: what meshopt unpacks, of a file together, and
# the zeros of an accessor that lists only its other elements.
MAX_UNPACKED_BYTES = 512 * BYTES_PER_MEGABYTE
MAX_ZEROS = 1_000_000
