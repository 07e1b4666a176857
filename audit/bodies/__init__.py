"""Bodies in the world, and what is derived from each once; a pair of them."""
