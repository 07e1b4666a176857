"""The figures of a pair: depth, gap, contacts, volume, touch band. Each runs only on request."""
