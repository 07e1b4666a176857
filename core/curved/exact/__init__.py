"""Contacts of curved shapes in exact arithmetic, for what the bounds of the solver leave open.

A body is the exact image of its shape under its matrix, and both are float64 numbers, so rational.
Along an axis with integer components the support value of such a body is q + sqrt(p) with rational
q and p: whether the axis separates two of them is decided by comparing squares. Where they touch
along such an axis a common point is rational, since a sum of square roots that is rational has
rational terms. So both halves of "they touch" are proven by integers alone.
"""
