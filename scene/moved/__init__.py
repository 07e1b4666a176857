"""Writes moved bodies back into the format that they were read from: scene files and USD."""
