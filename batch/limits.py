"""What the check of one world may cost."""

from __future__ import annotations

from msgspec import Struct


class Limits(Struct, frozen=True):
    """For one world. seconds: wall-clock time. megabytes: address space of its process, in MiB."""

    seconds: float = 600.0
    megabytes: int = 4096
