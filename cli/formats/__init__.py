"""Renderers: a report in, text out. They print nothing."""
