"""Slow truths. Nothing in here imports `satcheck`."""
