"""The registry of readers: which files are read, by what, and with which options.

Formats of this package are listed here. Plug-ins and other packages register theirs in the same
way (`core/plugins.py`). A reader is imported when the first file of its format is read. A reader
declares as options those choices that its format leaves to the user. They decide the geometry of a
check, so a report states them, and whoever reads the same files again needs the same ones.

The ending of an input decides its kind; for an unknown ending, the root of its XML does.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from functools import cache
from importlib import import_module
from pathlib import Path
from sys import float_info
from typing import Annotated, Any, Literal, TypeVar, get_args, get_origin

from msgspec import Meta, Struct, ValidationError, convert
from msgspec.structs import replace

from satcheck.core.errors import SatcheckError
from satcheck.core.plugins import failures, others, own
from satcheck.scene.access import StrPath
from satcheck.scene.document import Document
from satcheck.scene.errors import Refused
from satcheck.scene.files import limits
from satcheck.scene.opening import File as File
from satcheck.scene.opening import ReadLimits as ReadLimits
from satcheck.scene.opening import size_of, suffix_of
from satcheck.scene.words import meant

T = TypeVar("T")
_ZIP = b"PK\x03\x04"
InputKind = Literal["mesh", "document", "scene", "robot", "srdf"]

SCENE_SUFFIXES = frozenset((".json", ".toml"))
_SRDF = ".srdf"
_XACRO = ".xacro"  # expands to a URDF or an SRDF
# Elements of an SRDF that no URDF has. The outermost element of both is <robot>.
_SRDF_ELEMENTS = frozenset(
    ("group", "group_state", "end_effector", "virtual_joint", "passive_joint", "joint_property")
) | {"disable_collisions", "enable_collisions", "disable_default_collisions"}
_HEAD_BYTES = 1 << 20


GeometryKind = Literal["collision", "visual"]
OptionValue = bool | int | float | str | tuple[str, ...]
# By name, those that are not given left out.
ReadOptions = Mapping[str, OptionValue]


class Option(Struct, frozen=True):
    """An option of a reader.

    name: in scene files and reports; the command line also takes - for _. type: of its values, with
    their limits, such as `Annotated[float, Meta(gt=0)]`. help: one sentence, which says what it
    takes. default: None: the reader decides. is_length: in millimetres; the command line may give
    another unit. Readers may have options of one name and type, each with its default.
    """

    name: str
    type: Any
    help: str
    default: OptionValue | None = None
    is_length: bool = False

    def __post_init__(self) -> None:
        if not self.name.isidentifier():
            raise ValueError(f"an option of a reader is named {self.name!r}: letters, digits and _")

    @property
    def spelling(self) -> str:
        """Return its name on the command line."""
        return self.name.replace("_", "-")

    @property
    def choices(self) -> tuple[str, ...]:
        """Return the words that it takes; (): it takes other values."""
        return _words(self.type)

    def converted(self, value: OptionValue) -> OptionValue:
        """Return the value as the reader takes it. Raises SatcheckError."""
        try:
            made: OptionValue = convert(value, self.type)
        except ValidationError:
            raise self._refused(value) from None
        return made

    def parsed(self, text: str) -> OptionValue:
        """Return the value that a text states; a comma separates several. Raises SatcheckError."""
        try:
            made: OptionValue = convert(self._stated(text), self.type, strict=False)
        except ValueError:  # as a ValidationError is, too
            raise self._refused(text) from None
        return made

    def _stated(self, text: str) -> float | str | list[str]:
        if self.is_length:
            from satcheck.scene.units import parse_length

            return parse_length(text).in_units_of("mm")
        return text.split(",") if self._takes_several else text

    @property
    def _plain_type(self) -> Any:
        return get_args(self.type)[0] if get_origin(self.type) is Annotated else self.type

    @property
    def _takes_several(self) -> bool:
        return get_origin(self._plain_type) is tuple

    def _refused(self, value: object) -> SatcheckError:
        """Return what is wrong with a value. A number may be beyond the limits that `help` has."""
        if self._plain_type is bool:
            fit = "true or false"
        elif self.choices:
            several = ", or several with commas" if self._takes_several else ""
            fit = f"one of {', '.join(self.choices)}{several}"
        else:
            is_number = self._plain_type in (int, float)
            what = "a number" if is_number and not _states_number(value) else "another value"
            fit = f"{what} ({self.help})"
        return SatcheckError("bad-argument", f"{self.spelling} should be {fit}, not {value!r}")


def _states_number(value: object) -> bool:
    try:
        float(str(value))
    except ValueError:
        return False
    return True


# `--geometry` gives it.
GEOMETRY = Option("geometry", GeometryKind, "what is checked: collision or visual")


def facets(chord: float) -> tuple[Option, Option]:
    """Return the options of a reader that makes facets of curved faces. chord: its default."""
    return (
        Option(
            "chord_tolerance",
            Annotated[float, Meta(gt=0, le=float_info.max)],
            "how far facets may be off, in millimetres, above 0",
            chord,
            is_length=True,
        ),
        Option(
            "angular_tolerance",
            Annotated[float, Meta(gt=0, le=math.pi)],
            "the largest angle between facets, in radians, up to pi",
            0.5,
        ),
    )


def _words(kind: Any) -> tuple[str, ...]:
    if get_origin(kind) is Literal:
        return get_args(kind)
    return tuple(word for inner in get_args(kind) for word in _words(inner))


# Relatives of the formats that are read, and what to do with them.
_CONVERTIBLE = {
    ".stpz": "it is a packed STEP file: unpack it and name the .stp file",
    ".stpx": "it is STEP in XML: export a .stp file",
    ".stpxz": "it is packed STEP in XML: export a .stp file",
}


class NeedsChild(Exception):
    """Raised by a reader in this process that wants to be asked in a child process."""


class Reader(Struct, frozen=True):
    """A format of files with meshes, or of robots in XML.

    name: in reports. title: for people. endings: of the names of its files, in small letters.
    read: "module:function". The function takes a `File` and returns a `Document`; it raises
    Refused without a file name. kind: "mesh": the meshes of a file are one body, or a body
    each; "document": each node is a body, with rules; "robot": links and joints, without items, as
    a `RobotDocument`, or without `roots` the meshes that only the reader of the robot reads.
    options: what the user may choose; `File.options` has their values.
    marks: with which its content may begin, of those in `opening.py`. text: "plain": the reader is
    shown UTF-8 without a byte order mark; "own": its parser decodes the text. here: files up to
    this size, in bytes, are read in this process, all others, and all of other packages, in a child
    process. by_name: it opens the file itself. up: the axis that points up, if the format says so.
    complete: False: the reader may leave something out without a word, so that no pair is proven
    apart. roots: of a robot, the tags of the outermost element. texts: files of its endings in a
    folder are robots if they hold one of these, or one of the roots; None: all of them are.
    """

    name: str
    title: str
    endings: tuple[str, ...]
    read: str
    kind: Literal["mesh", "document", "robot"] = "mesh"
    options: tuple[Option, ...] = ()
    marks: tuple[bytes, ...] = ()
    text: Literal["none", "plain", "own"] = "none"
    here: float = 0
    by_name: bool = False
    up: Literal["y", "z"] | None = None
    complete: bool = True
    roots: tuple[str, ...] = ()
    texts: tuple[bytes, ...] | None = None

    def values(self, given: ReadOptions) -> dict[str, OptionValue | None]:
        """Return the values of its options, for `File.options`. Raises Refused for one that it does
        not take, while another reader takes it."""
        try:
            return {
                option.name: option.converted(given[option.name])
                if option.name in given
                else option.default
                for option in self.options
            }
        except SatcheckError as error:
            raise Refused("unsupported-feature", f"{self.title}: {error.message}") from None

    def checked(self, made: Document) -> Document:
        """Return a document that it has made, and what has to be said of all its documents. Raises
        Refused."""
        made.check()
        if self.complete:
            return made
        message = (
            "the library that reads it may leave out what it does not know: overlaps count as it "
            "places the bodies, and no pair is proven apart"
        )
        return replace(made, warnings=(*made.warnings, ("incomplete", message)))


def _native(name: str, *more: str, marks: tuple[bytes, ...] = ()) -> Reader:
    """The strict readers in C++."""
    read = "satcheck.scene.files.native_formats:read_native"
    endings = (f".{name}", *more)
    return Reader(name, name.upper(), endings, read, marks=marks, text="plain", here=math.inf)


def _gltf(name: str, title: str, marks: tuple[bytes, ...] = ()) -> Reader:
    return Reader(
        name,
        title,
        (f".{name}",),
        "satcheck.scene.files.gltf:read_gltf",
        options=(GEOMETRY,),
        marks=marks,
        text="plain" if name == "gltf" else "none",
        here=limits.IN_PROCESS_BYTES,
        up="y",  # the glTF 2.0 specification, 3.4
    )


_BUILT_IN = (
    _native("obj"),
    _native("stl", ".stla", ".stlb"),
    _native("ply", marks=(b"ply\n", b"ply\r\n")),
    _native("off"),
    _gltf("glb", "GLB", (b"glTF",)),
    _gltf("gltf", "glTF"),
    Reader("3mf", "3MF", (".3mf",), "satcheck.scene.files.threemf:read_3mf", marks=(_ZIP,)),
    Reader("dae", "DAE", (".dae",), "satcheck.scene.files.collada:read_collada", text="own"),
    Reader(
        "urdf",
        "URDF",
        (".urdf",),
        "satcheck.scene.robot.urdf:read_urdf",
        kind="robot",
        here=math.inf,
        roots=("robot",),
    ),
)
KINDS = (Reader,)


class _Registry(Struct):
    """robots: by the tags of outermost elements."""

    by_ending: dict[str, Reader] = {}
    by_name: dict[str, Reader] = {}
    robots: dict[str, Reader] = {}

    def add(self, readers: Iterable[Reader]) -> None:
        """A format that is there already stays."""
        for reader in readers:
            for root in reader.roots:
                self.robots.setdefault(root, reader)
            if reader.roots:
                continue
            self.by_name.setdefault(reader.name, reader)
            for ending in reader.endings:
                self.by_ending.setdefault(ending, reader)


@cache
def _registry() -> _Registry:
    registry = _Registry()
    registry.add(_BUILT_IN)
    registry.add(own("readers"))
    return registry


def readers() -> Mapping[str, Reader]:
    """Return the readers of this package and its plug-ins, by the endings of their files."""
    return _registry().by_ending


def robots() -> Mapping[str, Reader]:
    """Return the readers of robots, by the tags of outermost elements."""
    return _registry().robots


def robots_of(ending: str) -> tuple[Reader, ...]:
    """Return the readers of robots whose names end so."""
    registry, ending = _registry(), ending.lower()
    if not any(ending in robot.endings for robot in registry.robots.values()):
        _found(registry.by_ending, ending)
    known = dict.fromkeys(registry.robots.values())
    return tuple(robot for robot in known if ending in robot.endings)


def reader_of(ending: str) -> Reader | None:
    """Return the reader of files whose names end so; None: there is none."""
    return _found(_registry().by_ending, ending.lower())


def required_reader(ending: str) -> Reader:
    """Return the reader of files whose names end so. Raises Refused if there is none."""
    reader = reader_of(ending)
    if reader is not None:
        return reader
    others = ", ".join(sorted((*SCENE_SUFFIXES, *robot_endings(), ".srdf")))
    known = f"known are {mesh_endings()}, and of scenes and robots {others}"
    hint = _CONVERTIBLE.get(ending.lower(), known)
    message = f"unsupported format {ending!r}: {hint}{failures('readers', KINDS)}"
    raise Refused("unsupported-format", message)


def mesh_endings() -> str:
    """Return the endings of files that are meshes or documents, for messages."""
    return ", ".join(sorted(filter(mesh_reader, readers())))


def mesh_reader(suffix: str) -> Reader | None:
    """Return the reader of files that are meshes or documents; None: there is none."""
    reader = reader_of(suffix)
    return None if reader is None or reader.kind == "robot" else reader


def reader_named(name: str) -> Reader | None:
    """Return the reader of a format by its name in reports; None: this process has not looked for
    it, or there is none, as of shapes."""
    return _registry().by_name.get(name)


def robot_reader(root: str) -> Reader | None:
    """Return the reader of robots whose outermost element has this tag; None: there is none."""
    return _found(_registry().robots, root)


def is_complete(format_name: str) -> bool:
    """Return whether the reader of a format leaves nothing out without a word."""
    reader = reader_named(format_name)
    return reader is None or reader.complete


def options_of(formats: Iterable[str]) -> set[str]:
    """Return the names of the options that count for files of these formats."""
    known = filter(None, map(reader_named, formats))
    return {option.name for reader in known for option in reader.options}


def stated_options(given: ReadOptions, formats: Iterable[str]) -> dict[str, OptionValue] | None:
    """Return the options with which files of these formats are read, those that are given and the
    defaults on which all these formats agree; None: there is none."""
    defaults: dict[str, set[OptionValue | None]] = {}
    for reader in filter(None, map(reader_named, formats)):
        for option in reader.options:
            defaults.setdefault(option.name, set()).add(option.default)
    stated = dict(given)
    for name, values in defaults.items():
        (value, *others), is_given = values, name in given
        if not (is_given or others or value is None):
            stated[name] = value
    return stated or None


def option_named(name: str) -> Option:
    """Return an option of a reader; - may stand for _ in its name. Raises SatcheckError if no
    reader has it."""
    name = name.replace("-", "_")
    known = options()
    if name not in known:
        add_others()
        known = options()
    if name not in known:
        named = [f"{option.spelling} ({', '.join(titles)})" for option, titles in known.values()]
        failed = failures("readers", KINDS)
        spelling, there = name.replace("_", "-"), ", ".join(sorted(named))
        near = meant(spelling, [option.spelling for option, _ in known.values()])
        message = f"no reader has the option {spelling}{near}; there are {there}{failed}"
        raise SatcheckError("bad-argument", message)
    return known[name][0]


def options() -> dict[str, tuple[Option, list[str]]]:
    """Return all options by name, each with the titles of the formats that have it."""
    found: dict[str, tuple[Option, list[str]]] = {}
    registry = _registry()
    for reader in (*registry.by_name.values(), *registry.robots.values()):
        for option in reader.options:
            titles = found.setdefault(option.name, (option, []))[1]
            if reader.title not in titles:
                titles.append(reader.title)
    return found


def _found(among: Mapping[str, T], key: str) -> T | None:
    """Other packages are asked only for what this one does not have."""
    if key and key not in among:
        add_others()
    return among.get(key)


def add_others() -> None:
    """Register the readers of other packages, which takes as long as a small check. They run in a
    child process: they may fail."""
    _registry().add(replace(reader, here=0) for reader in others("readers", KINDS))


def kind_of(path: str) -> InputKind:
    """ "mesh" if no other kind fits. Its reader then reports errors."""
    suffix = suffix_of(path).lower()
    if suffix in SCENE_SUFFIXES:
        return "scene"
    if suffix == _SRDF:
        return "srdf"
    if suffix not in readers() and robots_of(suffix):
        return "robot"
    reader = mesh_reader(suffix)
    if reader is not None:
        return "document" if reader.kind == "document" else "mesh"
    root, *below = _first_elements(path)
    if root == "robot":
        return "srdf" if below and below[0] in _SRDF_ELEMENTS else "robot"
    return "robot" if suffix == _XACRO or robot_reader(root) is not None else "mesh"


def robot_endings() -> frozenset[str]:
    """Return the endings of files that may be robots."""
    return frozenset(ending for reader in robots().values() for ending in reader.endings)


def reader_of_robot(location: StrPath) -> Reader | None:
    """Return the reader of robots with this outermost element; None: it is none of a robot."""
    return robot_reader(_first_elements(location)[0])


def _first_elements(location: StrPath) -> list[str]:
    """The names of the root and of its first element; [""] if the file is not XML."""
    try:
        size_of(location)
        with Path(location).open("rb") as file:
            head = file.read(_HEAD_BYTES)
    except (SatcheckError, OSError):  # reported when the file is read
        return [""]
    if not head.lstrip().startswith((b"<", b"\xef\xbb\xbf", b"\xff\xfe", b"\xfe\xff")):
        return [""]
    from satcheck.scene.robot.reading import first_tags

    return first_tags(head, 2) or [""]


def imported(module: str, extra: str, kind: str) -> Any:
    """The module. extra: of satcheck, which installs it. kind: of file, such as "IFC files"."""
    try:
        return import_module(module)
    except ModuleNotFoundError as error:
        if error.name is None or not module.startswith(error.name):
            raise
        library = module.partition(".")[0]
        message = f"{kind} need {library}: pip install 'satcheck[{extra}]'"
        raise Refused("missing-extra", message) from None
