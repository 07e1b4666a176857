"""What reads files, by the kind of the file, and small good files of each kind."""

from __future__ import annotations

import pickle
from collections.abc import Callable, Mapping
from contextlib import chdir
from functools import cache
from pathlib import Path

import msgspec

from satcheck.audit import check
from satcheck.audit.baseline import read_baseline
from satcheck.cli.config import nearest_config, read_config
from satcheck.cli.formats.picture.html import render as page
from satcheck.cli.stated_scene import read_stored, stated_scene
from satcheck.core.errors import SatcheckError
from satcheck.report.assets import AssetsReport
from satcheck.report.report import Report
from satcheck.scene import Refused, Scene, load_scene
from satcheck.scene.document import Document, Refusal
from satcheck.scene.files.nodes import flattened
from satcheck.scene.files.readers import File, required_reader
from satcheck.scene.files.reading_children import Reply, serve
from satcheck.scene.mesh_files import MeshFiles
from satcheck.scene.robot.poses import read_poses
from satcheck.verify import Rejected, parse, verify
from tests.fuzz.written import written
from tests.plugin_marks import has

ROOT = Path(__file__).resolve().parents[2]
SAMPLES = ROOT / "sample_meshes"
SEEDS = ROOT / "scene" / "native" / "tests" / "fuzz" / "seeds"

# Reads the file at a path. Raises SatcheckError or Rejected for one that it refuses.
Reader = Callable[[Path], object]


def read_bodies(path: Path) -> None:
    refuse_errors(load_scene([path], split="none"))
    refuse_errors(load_scene([path], split="components"))


def refuse_errors(scene: Scene) -> None:
    for issue in scene.issues:
        if issue.severity == "error":
            raise SatcheckError(issue.code, issue.message)


def read_in_this_process(path: Path) -> None:
    """What a reading child does. Its parent would turn every exception into `reader-failed`."""
    data = path.read_bytes()
    reader = required_reader(path.suffix)
    options = reader.values({})
    file = File(reader.name, str(path.parent), path.name, data, options)
    reply = serve(pickle.dumps((reader.read, file)))
    content = msgspec.msgpack.decode(reply, type=Reply[Document]).content
    if isinstance(content, Refusal):
        raise Refused(content.code, content.message)
    flattened(reader.checked(content))


def read_scene(path: Path) -> None:
    scene = load_scene([path])
    if len(scene.bodies) < 20:
        check(scene)


_MODELS = MeshFiles()  # one child process for all files


def read_model(path: Path) -> None:
    """MuJoCo works in a child process. One that it loses is a fault."""
    try:
        _MODELS.robot(str(path), {}, "collision")
    except Refused as error:
        if error.code == "reader-failed":
            raise RuntimeError(error.message) from error
        raise


def read_states(path: Path) -> None:
    """An SRDF beside the robot that it is about."""
    refuse_errors(load_scene([SAMPLES / "arm.urdf", path]))


def read_settings(path: Path) -> None:
    with chdir(path.parent):
        nearest_config()
    read_config(path)


def verify_report(path: Path) -> None:
    verify(parse(path.read_text("utf-8", "replace")), path.parent)


def view_report(path: Path) -> None:
    report = read_stored(path)
    reports = [report] if isinstance(report, Report) else []
    if isinstance(report, AssetsReport):
        reports = [asset.report for asset in report.assets]
    for each in reports:
        scene, _ = stated_scene(each, path.parent)
        page(each, scene)


READERS: Mapping[str, Reader] = {
    **dict.fromkeys(("obj", "stl", "ply", "off", "glb", "gltf"), read_bodies),
    **dict.fromkeys(("3mf", "dae"), read_in_this_process),
    **dict.fromkeys(("toml", "json", "urdf", *(["sdf"] if has("sdf") else [])), read_scene),
    **({"mjcf": read_model} if has("mjcf") else {}),
    "srdf": read_states,
    "config": read_settings,
    "baseline": read_baseline,
    "pose": lambda path: read_poses(str(path)),
    "verify": verify_report,
    "view": view_report,
}
# The name of a file of the kind, where its ending is not the kind.
_NAMES = {
    "config": "satcheck.toml",
    "mjcf": "file.xml",
    **dict.fromkeys(("baseline", "pose", "verify", "view"), "document.json"),
}


def name_of(kind: str) -> str:
    return _NAMES.get(kind, f"file.{kind}")


def attempt(kind: str, path: Path) -> str:
    """The code of the error; "" for a file that is read. Raises what no reader should raise."""
    try:
        READERS[kind](path)
    except SatcheckError as error:
        return error.code
    except Rejected:
        return "rejected"
    return ""


@cache
def seeds(kind: str) -> list[bytes]:
    """Good files, and of native readers also the inputs that the fuzzer started from."""
    files = [path for path in sorted(SAMPLES.iterdir()) if path.suffix == f".{kind}"]
    native = SEEDS / kind
    files += sorted(native.iterdir()) if native.is_dir() else []
    return [path.read_bytes() for path in files] + written(kind)
