"""The options that come from a config file, in words."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Iterable

    from satcheck.report.report import Report
    from satcheck.report.settings import OptionValue, StatedConfig


def config_lines(reports: Iterable[Report]) -> list[str]:
    """A line for each config file that took effect."""
    stated = (report.config for report in reports)
    return list(dict.fromkeys(config_line(config) for config in stated if config is not None))


def config_line(config: StatedConfig) -> str:
    """`Options of satcheck.toml: tolerance = 0.1, fail-on = "warning"`."""
    options = (f"{name} = {toml(value)}" for name, value in config.options.items())
    return f"Options of {config.file}: {', '.join(options)}"


def toml(value: OptionValue) -> str:
    """The value as TOML writes it; JSON writes texts, numbers and lists of texts alike."""
    return json.dumps(value, ensure_ascii=False)
