"""Batches: many worlds, each checked as a scene of its own, in processes that may die."""
