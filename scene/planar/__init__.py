"""Bodies in a plane: the outlines of meshes, as prisms (`laid_flat`)."""
