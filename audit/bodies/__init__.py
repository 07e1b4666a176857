"""Bodies in the world, the data derived from each, and pairs of bodies."""
