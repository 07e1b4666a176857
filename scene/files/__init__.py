"""Readers of mesh files of any supported format."""
