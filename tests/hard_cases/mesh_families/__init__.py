"""One module a category of mesh pairs; each yields its cases from a seed."""

from __future__ import annotations

from tests.hard_cases.mesh_case import MeshFamily
from tests.hard_cases.mesh_families import grids, links, random_grids

FAMILIES: tuple[MeshFamily, ...] = (grids, random_grids, links)
