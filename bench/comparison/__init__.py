"""What bench/compare.py runs: two environments, the benches, and what their figures say."""
