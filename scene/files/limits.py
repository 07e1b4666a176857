"""Limits of a file. Each guards against small files that become huge."""

from __future__ import annotations

BYTES_PER_MEGABYTE = 1 << 20

# A reader needs up to about three times a text file's size, so a file may take this share of the
# memory limit.
FILE_SHARE_OF_MEMORY = 4

# Instances multiply: a dozen nested components can expand to 10^12 instances or triangles.
MAX_PLACEMENTS = 1_000_000
MAX_TRIANGLES = 50_000_000
MAX_VERTICES = 3 * MAX_TRIANGLES
MAX_DEPTH = 200  # of elements in XML and keys in TOML; no program nests deeper

# XML compresses about 4:1 to 20:1. A part with a higher ratio that unpacks to more than a few
# megabytes is an attack or filler.
MAX_INFLATION = 200
SMALL_PART_BYTES = 8 * BYTES_PER_MEGABYTE
MAX_PART_BYTES = 1024 * BYTES_PER_MEGABYTE

# Our own code reads glTF and checks every range. Its JSON can cost a few tens of times its size.
# Up to this size a child process would only cost time.
IN_PROCESS_BYTES = 4 * BYTES_PER_MEGABYTE
# What such a file may cost in this process: files that it names, data that it unpacks, and numbers
# that it names again and again. Beyond that a child process reads it.
IN_PROCESS_WORK = 256 * BYTES_PER_MEGABYTE

# glTF data that take almost no space in the file: all data of a file that meshopt unpacks, and
# the zeros of a sparse accessor.
MAX_UNPACKED_BYTES = 512 * BYTES_PER_MEGABYTE
MAX_ZEROS = 1_000_000
