"""Files that hold geometry in formats that no reader knows, by the ending of the name."""

from __future__ import annotations

import shlex
from collections.abc import Iterable
from glob import escape
from pathlib import Path, PurePath

from satcheck.scene.bodies import Scene
from satcheck.scene.files.readers import reader_of, robots_of
from satcheck.scene.issue import issue

# Program or format -> endings. Endings that other kinds of files share are left out.
_ENDINGS = {
    "FBX": "fbx",
    "Blender": "blend",
    "3ds Max": "max 3ds",
    "Maya": "ma mb",
    "Cinema 4D": "c4d",
    "SketchUp": "skp",
    "Houdini": "hip hiplc hipnc bgeo bgeo.sc usdnc usdlc",
    "LightWave": "lwo lws",
    "Modo": "lxo",
    "ZBrush": "ztl zpr",
    "Alembic": "abc",
    "OpenVDB": "vdb",
    "X3D": "x3d x3db x3dv x3dz",
    "VRML": "wrl vrml wrz",
    "AMF": "amf amf.xml",
    "DirectX": "x",
    "OpenCTM": "ctm",
    "Nexus": "nxs nxz",
    "Ogre or Medit": "mesh mesh.xml",
    "MilkShape": "ms3d",
    "Quake or Source": "md2 md3 md5mesh bsp vmf smd",
    "MikuMikuDance": "pmd pmx",
    "VRM": "vrm",
    "RenderWare": "dff",
    "NetImmerse": "nif",
    "VoxelMax or MagicaVoxel": "vox",
    "Universal 3D": "u3d",
    "STEP in another form": "stpz stpx stpxz",
    "IGES": "igs iges",
    "IFC in another form": "ifcjson ifcxml",
    "dotbim": "bim",
    "xeokit": "xkt",
    "SolidWorks": "sldprt sldasm eprt easm",
    "CATIA": "catpart catproduct cgr",
    "Creo or NX": "prt asm neu pvz",
    "Solid Edge": "par psm",
    "Inventor": "ipt iam",
    "Parasolid": "x_t x_b xmt_txt xmt_bin",
    "ACIS": "sat sab",
    "JT": "jt",
    "OpenCASCADE": "brep brp",
    "FreeCAD": "fcstd",
    "Fusion": "f3d f3z",
    "Rhino": "3dm",
    "AutoCAD": "dwg dxf dwf dwfx",
    "MicroStation": "dgn",
    "Revit": "rvt rfa",
    "Archicad": "pln",
    "AVEVA": "rvm",
    "Navisworks": "nwd nwc nwf",
    "OpenSCAD": "scad",
    "Draco": "drc",
    "OpenSceneGraph": "osg osgb osgt ive",
    "Open Inventor": "iv",
    "3D Tiles": "b3dm i3dm cmpt",
    "CityGML": "gml city.json",
    "VTK": "vtk vtp vtu vtm pvtp pvtu",
    "finite elements": "msh nas bdf unv cgns exo",
    "scanned points": "pcd e57 las laz splat ksplat spz",
    "LDraw": "ldr mpd lxf",
    "Google Earth": "kmz",
    "PRC": "prc",
    "PLMXML": "plmxml",
    "POV-Ray": "pov",
    "Babylon.js": "babylon",
    "Unity": "unity prefab",
    "Godot": "tscn escn scn",
    "Unreal": "uasset umap t3d",
    "Roblox": "rbxl rbxlx rbxm rbxmx",
    "Webots": "wbt",
    "CoppeliaSim": "ttt ttm",
    "OpenRAVE": "kinbody.xml robot.xml env.xml",
    "xacro, which `xacro FILE` expands to URDF,": "xacro",
    "MuJoCo, which satcheck reads by the ending .xml": "mjcf mjb",
    "archives": "zip 7z rar tar tgz tbz2 txz",
}
_PROGRAMS = {f".{end}": name for name, ends in _ENDINGS.items() for end in ends.split()}
_PACKED = frozenset((".gz", ".bz2", ".xz", ".zst", ".lz4", ".lzma", ".br", ".z"))
_VERSIONED = frozenset((".prt", ".asm"))  # Creo counts its files: bolt.prt.12


def is_foreign(path: str | Path) -> bool:
    """Return whether a file holds geometry, and neither this package nor a plug-in reads it."""
    return _program(path) is not None


def _program(path: str | Path) -> str | None:
    """What wrote the file, by the end of its name; None: another file, or one that is read."""
    *others, ending = [""] + [each.lower() for each in Path(path).suffixes]
    inner = others[-1] if others else ""
    if ending in _PACKED:
        packed = inner in _PROGRAMS or reader_of(inner) or robots_of(inner)
        return f"the compression {ending[1:]}" if packed else None
    if ending[1:].isdecimal() and inner in _VERSIONED:
        ending = inner
    if inner + ending in _PROGRAMS:
        return _PROGRAMS[inner + ending]
    return None if reader_of(ending) else _PROGRAMS.get(ending)


def foreign_scene(folder: str, files: Iterable[str]) -> Scene:
    """Return the scene of such files of a folder: no body, and an issue for each file."""
    issues = [
        issue(
            "unread-file",
            f"files of {_program(file)} are not read: export it to a format "
            f"that is, --exclude {shlex.quote(name)}, or "
            f"--accept {shlex.quote(f'unread-file:{escape(name)}')}",
            file=file,
        )
        for file, name in ((file, PurePath(file).name) for file in files)
    ]
    return Scene(name=folder, units=None, bodies=(), issues=tuple(issues))
