"""The separating axis theorem on two convex hulls: candidate axes, and the shadows on them.

shadows -> candidates. A check asks `core.pairs` instead, in C++; here every axis is kept, and so is
where it comes from.
"""
