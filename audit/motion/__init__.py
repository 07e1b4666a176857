"""The sweep of a pair: whether moving bodies hit each other; see docs/scenes.md."""
