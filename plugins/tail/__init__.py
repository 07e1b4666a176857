"""The tail: formats that trimesh reads and satcheck does not. README.md says what that means."""
