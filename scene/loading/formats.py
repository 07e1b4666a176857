"""The formats of mesh files, by the ending of the name."""

from __future__ import annotations

FORMATS = {
    ".obj": "obj",
    ".stl": "stl",
    ".stla": "stl",
    ".stlb": "stl",
    ".ply": "ply",
    ".off": "off",
    ".glb": "glb",
    ".gltf": "gltf",
    ".3mf": "3mf",
    ".dae": "dae",
    ".step": "step",
    ".stp": "step",
    ".p21": "step",
    ".ifc": "ifc",
    ".ifczip": "ifc",
    ".ifcxml": "ifc",
    ".usd": "usd",
    ".usda": "usd",
    ".usdc": "usd",
    ".usdz": "usd",
}
# Formats of scenes: each node is a body, with rules, whatever files are beside it.
DOCUMENTS = frozenset(("usd", "ifc"))
