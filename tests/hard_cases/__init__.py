"""Hard pairs with exact truth: generated from a seed, judged without a tolerance."""
