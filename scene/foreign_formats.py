"""Files that hold geometry in formats that no reader knows, by the ending of the name."""

from __future__ import annotations

import shlex
from collections.abc import Iterable
from pathlib import Path, PurePath

from satcheck.scene.bodies import Scene
from satcheck.scene.issue import issue
from satcheck.scene.loading.readers import reader_of

# Program or format -> endings. Endings that other kinds of files share are left out.
_ENDINGS = {
    "FBX": "fbx",
    "Blender": "blend",
    "3ds Max": "max 3ds",
    "Maya": "ma mb",
    "Cinema 4D": "c4d",
    "SketchUp": "skp",
    "Houdini": "hip hiplc hipnc bgeo",
    "LightWave": "lwo lws",
    "Modo": "lxo",
    "ZBrush": "ztl zpr",
    "Alembic": "abc",
    "OpenVDB": "vdb",
    "X3D": "x3d x3db x3dv x3dz",
    "VRML": "wrl vrml wrz",
    "AMF": "amf",
    "OpenCTM": "ctm",
    "Ogre or Medit": "mesh",
    "MilkShape": "ms3d",
    "Quake": "md2 md3 md5mesh",
    "MikuMikuDance": "pmd pmx",
    "VRM": "vrm",
    "Universal 3D": "u3d",
    "STEP in another form": "stpz stpx stpxz",
    "IGES": "igs iges",
    "SolidWorks": "sldprt sldasm",
    "CATIA": "catpart catproduct cgr",
    "Creo or NX": "prt asm",
    "Solid Edge": "par psm",
    "Inventor": "ipt iam",
    "Parasolid": "x_t x_b xmt_txt xmt_bin",
    "ACIS": "sat sab",
    "JT": "jt",
    "OpenCASCADE": "brep brp",
    "FreeCAD": "fcstd",
    "Fusion": "f3d f3z",
    "Rhino": "3dm",
    "AutoCAD": "dwg dxf",
    "MicroStation": "dgn",
    "Revit": "rvt rfa",
    "Archicad": "pln",
    "Navisworks": "nwd nwc nwf",
    "OpenSCAD": "scad",
    "Draco": "drc",
    "OpenSceneGraph": "osgb osgt ive",
    "3D Tiles": "b3dm i3dm cmpt",
    "VTK": "vtp vtu",
    "LDraw": "ldr mpd lxf",
    "Google Earth": "kmz",
    "PRC": "prc",
    "PLMXML": "plmxml",
    "MuJoCo, which satcheck reads by the ending .xml": "mjcf",
}
_PROGRAMS = {f".{end}": name for name, ends in _ENDINGS.items() for end in ends.split()}


def is_foreign(path: str | Path) -> bool:
    """Return whether a file holds geometry, and neither this package nor a plug-in reads it."""
    ending = Path(path).suffix.lower()
    return ending in _PROGRAMS and reader_of(ending) is None


def foreign_scene(folder: str, files: Iterable[str]) -> Scene:
    """Return the scene of such files of a folder: no body, and an issue for each file."""
    issues = [
        issue(
            "unread-file",
            f"files of {_PROGRAMS[Path(file).suffix.lower()]} are not read: export it to a format "
            f"that is, --exclude {shlex.quote(PurePath(file).name)}, or accept it",
            file=file,
        )
        for file in files
    ]
    return Scene(name=folder, units=None, bodies=(), issues=tuple(issues))
