"""USD: the prims of a stage as bodies. README.md says what is read."""
