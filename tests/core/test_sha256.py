"""The digest of a file's bytes is that of hashlib."""

from __future__ import annotations

import hashlib
import random

from satcheck.core import sha256


def test_as_hashlib_has_it() -> None:
    source = random.Random(2)
    for size in [*range(200), 1000, 4096, 100_003]:
        data = source.randbytes(size)
        assert sha256(data) == hashlib.sha256(data).hexdigest()
