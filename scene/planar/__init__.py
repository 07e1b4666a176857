"""Bodies seen as flat: the outlines of meshes in a plane, as prisms (`laid_flat`)."""
