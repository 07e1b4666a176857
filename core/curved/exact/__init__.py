"""Decides contacts of curved shapes in exact arithmetic, if the bounds of the solver do not.

A body is the exact image of its shape under its matrix. Sizes and matrix are float64 numbers, so
they are rational. Along an axis with integer components, the support value of such a body is q +
sqrt(p) with rational q and p. Comparing squares decides whether the axis separates two bodies. If
they touch along such an axis, their common point is rational, because a rational sum of square
roots has rational terms. Integers therefore prove both parts of a touch: no overlap, and a common
point.
"""
