"""The options that choose and read the files of a scene. Several commands share them.

Help lists the options of a group in the order of the group.
"""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any, TypeVar, get_args

import click

from satcheck.cli.option import Told, Whole, limits, together
from satcheck.core.errors import SatcheckError
from satcheck.scene.files.readers import GEOMETRY, GeometryKind, OptionValue, option_named, options
from satcheck.scene.opening import is_folder
from satcheck.scene.units import MICROMETRES

_Command = TypeVar("_Command", bound=Callable[..., Any])


def _about_read() -> str:
    known = options().values()
    spelled = sorted(option.spelling for option, _ in known if option is not GEOMETRY)
    named = f": {', '.join(spelled)}" if spelled else ""
    return f"An option of the readers of some formats{named}. Repeatable."


def _read(_: click.Context, __: click.Parameter, texts: tuple[str, ...]) -> dict[str, OptionValue]:
    """The values of options of readers, by name."""
    read: dict[str, OptionValue] = {}
    for text in texts:
        spelling, equals, value = text.partition("=")
        if not (equals and spelling):
            raise click.BadParameter(f"{text!r} should be NAME=VALUE")
        try:
            option = option_named(spelling)
            stated = option.parsed(value)
        except SatcheckError as error:
            raise click.BadParameter(error.message) from None
        if option.name == GEOMETRY.name:
            raise click.BadParameter("--geometry gives the geometry")
        if option.name in read:
            raise click.BadParameter(f"{spelling} is given twice")
        read[option.name] = stated
    return read


SPLITS = ("nodes", "components", "none")

outside = click.option(
    "--allow-outside",
    is_flag=True,
    help="Read what a file names outside of its folder.",
)
read = click.option(
    "--read",
    "reading",
    cls=Told,
    tell=_about_read,
    multiple=True,
    metavar="NAME=VALUE",
    callback=_read,
)


def reading(*more: str) -> Callable[[_Command], _Command]:
    """Return the options about what reading a file may do. more: names of further limits."""
    return together(outside, limits(*more), read)


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
    type=click.Path(dir_okay=False),
    metavar="FILE",
    callback=lambda _, __, files: tuple(str(Path(file)) for file in files),
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


def _packages(_: click.Context, __: click.Parameter, texts: tuple[str, ...]) -> dict[str, str]:
    packages: dict[str, str] = {}
    for text in texts:
        name, _equals, folder = text.partition("=")
        if not name or not folder:
            raise click.BadParameter(f"{text!r} should be NAME=DIR")
        if not is_folder(folder):
            raise click.BadParameter(f"{folder!r} is no folder")
        packages[name] = str(Path(folder))
    return packages


package = click.option(
    "--package",
    "packages",
    multiple=True,
    metavar="NAME=DIR",
    callback=_packages,
    help="The folder of a package or model, or of a part of it. Repeatable.",
)


geometry = click.option(
    "--geometry",
    type=click.Choice(get_args(GeometryKind)),
    metavar="KIND",
    help="collision (default: robots) or visual (default: USD).",
)
# That pose robots once.
one_pose = together(
    click.option(
        "--pose",
        multiple=True,
        metavar="FILE",
        help='Values of joints (radians, metres), {"joint": value}: a JSON file or the text. '
        "A check takes several.",
    ),
    click.option(
        "--state",
        multiple=True,
        metavar="NAME",
        help="A state of the SRDF; --pose overrides it. Repeatable.",
    ),
)
# That pose robots.
poses = together(
    one_pose,
    click.option(
        "--sample",
        type=Whole(min=1),
        metavar="N",
        help="Check N random poses; joints in --pose and --state stay.",
    ),
    click.option(
        "--seed",
        type=Whole(min=0),
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
# Of commands that read one scene.
scene = together(split, merge, units, reading(), package, geometry)
# The same, with robots in one pose.
one_scene = together(scene, one_pose)
