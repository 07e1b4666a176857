"""The options that choose and read the files of a scene. Several commands share them.

Help lists the options of a group in the order of the group.
"""

from __future__ import annotations

import math
from pathlib import Path
from typing import get_args

import click

from satcheck.cli.option import DEFAULTS, millimetres, seconds, together
from satcheck.scene.files.readers import readers
from satcheck.scene.paths import is_folder
from satcheck.scene.read_options import (
    ANGULAR_TOLERANCE,
    GeometryKind,
    Purpose,
)
from satcheck.scene.units import MICROMETRES


def _chords() -> str:
    """The chord tolerances of the formats that have one."""
    formats = {r.title: r.chord for r in readers().values() if r.chord is not None}
    return ", ".join(f"{title}: {chord:g}mm" for title, chord in formats.items())


SPLITS = ("nodes", "components", "none")

outside = click.option(
    "--allow-outside",
    is_flag=True,
    help="Read what a file names outside of its folder.",
)
# About what reading a file may do.
reading = together(
    outside,
    seconds(
        "--seconds-per-file",
        DEFAULTS.seconds_per_file,
        "The most time for reading a mesh file.",
    ),
    click.option(
        "--megabytes-per-file",
        type=click.IntRange(1),
        metavar="MIB",
        default=DEFAULTS.megabytes_per_file,
        show_default=True,
        help="The most memory for reading a mesh file; the file may be a quarter as large.",
    ),
    click.option(
        "--chord-tolerance",
        type=millimetres,
        metavar="LENGTH",
        help=f"How far facets of curved faces may be off [{_chords()}].",
    ),
    click.option(
        "--angular-tolerance",
        type=click.FloatRange(0, math.pi, min_open=True),
        metavar="RADIANS",
        default=ANGULAR_TOLERANCE,
        show_default=True,
        help="The largest angle between them.",
    ),
)
split = click.option(
    "--split",
    type=click.Choice(SPLITS),
    metavar="HOW",
    help="A body is a node (nodes, the default for one file alone), a connected piece (components) "
    "or a file (none).",
)
units = click.option(
    "--units",
    type=click.Choice(tuple(MICROMETRES)),
    metavar="UNIT",
    help=f"The unit of files without one: {', '.join(MICROMETRES)}.",
)
merge = click.option(
    "--merge",
    is_flag=True,
    help="Put several scene files into one world.",
)
rules = click.option(
    "--rules",
    multiple=True,
    type=click.Path(dir_okay=False, path_type=Path),
    metavar="FILE",
    help="Rules about all bodies, after those of scenes: what may overlap, and by how much. "
    "Repeatable.",
)


between = click.option(
    "--between",
    nargs=2,
    multiple=True,
    metavar="X Y",
    help="Only pairs of X and Y: ids or group:NAME. Repeatable.",
)


def _packages(_: click.Context, __: click.Parameter, texts: tuple[str, ...]) -> dict[str, Path]:
    packages: dict[str, Path] = {}
    for text in texts:
        name, _equals, folder = text.partition("=")
        if not name or not folder:
            raise click.BadParameter(f"{text!r} should be NAME=DIR")
        if not is_folder(folder):
            raise click.BadParameter(f"{folder!r} is no folder")
        packages[name] = Path(folder)
    return packages


package = click.option(
    "--package",
    "packages",
    multiple=True,
    metavar="NAME=DIR",
    callback=_packages,
    help="The folder of a package or model, or of a part of it. Repeatable.",
)


def _time(_: click.Context, parameter: click.Parameter, value: float | None) -> float | None:
    if value is not None and not math.isfinite(value):
        raise click.BadParameter("a finite number", param=parameter)
    return value


# That choose between the geometries of a file.
geometry = together(
    click.option(
        "--geometry",
        type=click.Choice(get_args(GeometryKind)),
        metavar="KIND",
        help="collision (default: robots) or visual (default: USD).",
    ),
    click.option(
        "--purpose",
        multiple=True,
        type=click.Choice(get_args(Purpose)),
        metavar="NAME",
        help="The drawn prims of USD: render (default), proxy, guide.",
    ),
    click.option(
        "--time",
        type=float,
        metavar="TIME",
        callback=_time,
        help="The time code of USD files.",
    ),
    click.option(
        "--mesh-hulls",
        is_flag=True,
        help="Check the hulls of MJCF meshes, as MuJoCo does.",
    ),
)
# That pose robots.
poses = together(
    click.option(
        "--pose",
        multiple=True,
        metavar="FILE",
        help='Values of joints (radians, metres), {"joint": value}: a JSON file or the text. '
        "Several are checked one by one.",
    ),
    click.option(
        "--state",
        multiple=True,
        metavar="NAME",
        help="A state of the SRDF; --pose overrides it. Repeatable.",
    ),
    click.option(
        "--sample",
        type=click.IntRange(min=1),
        metavar="N",
        help="Check N random poses; joints in --pose and --state stay.",
    ),
    click.option(
        "--seed",
        type=click.IntRange(min=0),
        metavar="N",
        help="The seed of the random poses.  [default: 0]",
    ),
)


# That sweeps robots.
joint_path = click.option(
    "--path",
    "joint_path",
    type=click.Path(),
    metavar="FILE",
    help="Sweep robots through these poses (JSON or CSV).",
)
# That pose robots once.
one_pose = together(
    click.option(
        "--pose",
        multiple=True,
        metavar="FILE",
        help="Values of the joints of a robot, for one pose, as in a check.",
    ),
    click.option(
        "--state", multiple=True, metavar="NAME", help="A state that the SRDF names, as in a check."
    ),
)
# Of commands that check one scene, with robots in one pose.
one_scene = together(
    split,
    merge,
    package,
    geometry,
    one_pose,
    units,
    reading,
)
