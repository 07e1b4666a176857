"""The figures of a pair, each only where needed: depth, gap, contacts, volume, touch band."""
