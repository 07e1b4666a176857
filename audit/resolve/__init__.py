"""Pushing the bodies of a scene apart."""
