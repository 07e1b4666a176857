"""The request of each pair, from flags and rules, and the trace of its steps."""
