"""Drawings, SVG and DXF: flat shapes bounded by contours, for checks in a plane."""
