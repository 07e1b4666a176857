"""satcheck.studies: studies that ask the checker about one pair many times.

`tradeoff` measures what accuracy costs in time. `stability` asks a question in other ways that must
not change the answer. A check needs nothing of this room.
"""
