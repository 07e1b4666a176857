"""Millions of seeded convex pairs against invariants, a sample of them against rationals."""
