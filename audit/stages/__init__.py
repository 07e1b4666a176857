"""The stages of a pair: each finds a part of what its draft says. Most run only on request."""
