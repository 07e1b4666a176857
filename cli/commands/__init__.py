"""The sub-commands, a file each: `command` is the click command, imported when it is called for."""
