"""satcheck.studies: studies that ask the checker about one pair many times.

`tradeoff` measures what accuracy costs in time. `stability` checks variants of a pair that must not
change the answer. A check imports nothing from this room.
"""
