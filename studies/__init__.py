"""satcheck.studies: studies that ask the checker about one pair many times.

`tradeoff` measures what accuracy costs in time. A check imports nothing from this room.
"""
