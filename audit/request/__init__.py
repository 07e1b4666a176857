"""What is asked of each pair, by flags and rules, and the record of what was done about it."""
