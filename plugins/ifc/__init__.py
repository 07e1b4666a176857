"""IFC: the elements of a building as bodies, and findings as BCF topics. README.md says more."""
