"""satcheck.plugins: formats that need a library of their own, a folder each.

Only the registry imports them, by their names (`core/plugins.py`).
"""
