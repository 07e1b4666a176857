"""The options of a check that a config file sets."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Annotated

from msgspec import Meta

from satcheck.report.values import Value

OptionValue = bool | int | float | str | tuple[str, ...]


class StatedConfig(Value, frozen=True):
    """file: the config file, relative to the folder of the command. options: each that it sets and
    the command line does not, by its name without the dashes, as the file has it."""

    file: str
    options: Annotated[Mapping[str, OptionValue], Meta(min_length=1)]
