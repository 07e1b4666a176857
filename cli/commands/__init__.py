"""The sub-commands, a file each: `command` is the click command, imported when it is called for."""

from __future__ import annotations

# Each is `command` in the module of its name here, imported when it is called.
COMMANDS = ("cache", "resolve", "schema", "stability", "suggest", "tradeoff", "verify")
