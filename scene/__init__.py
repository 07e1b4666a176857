"""satcheck: TODO."""
