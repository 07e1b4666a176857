"""The command: its units, and the whole process."""
