"""The figures of a pair: depth, way out, gap, contacts, volume, touch band: where asked for."""
