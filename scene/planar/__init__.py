"""Bodies in a plane: the outlines of meshes, as prisms (`flat_scene`)."""
