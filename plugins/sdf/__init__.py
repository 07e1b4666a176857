"""SDFormat (.sdf, .world; http://sdformat.org/spec). README.md says what is read."""
