"""STEP (ISO 10303-21), read by OpenCascade through cascadio. README.md says what is read."""
