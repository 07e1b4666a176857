"""The check of one world of a batch, in this process."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from functools import partial
from pathlib import Path

from msgspec.structs import replace

from satcheck.audit.assets import check_asset
from satcheck.audit.baseline import beside_baseline
from satcheck.audit.baseline_file import asset_key, current_baseline
from satcheck.audit.batch.options import CheckOptions, World
from satcheck.core.errors import SatcheckError
from satcheck.core.steps import step
from satcheck.report.assets import Asset, asset
from satcheck.report.report import Report
from satcheck.scene import Scene
from satcheck.scene.foreign_formats import foreign_scene, is_foreign
from satcheck.scene.mesh_files import KnownMeshes
from satcheck.scene.opening import exists, is_folder

# Why a file that is as it should be has no body that can collide.
_NO_BODY = "no-body"
_WITHOUT_BODIES = ("no-collision-geometry", "not-a-body", "left-out", _NO_BODY)


def foreign_worlds(files: Mapping[str, Sequence[str]]) -> list[World]:
    """Return a world for each folder that has files which no reader knows: the folder, and these.
    Its check says that they are not read."""
    return [(folder, *names) for folder, names in files.items() if names]


def _is_foreign(world: World) -> bool:
    return len(world) > 1 and is_folder(world[0]) and all(map(is_foreign, world[1:]))


def check_world(
    world: World,
    options: CheckOptions,
    *,
    hashed: bool = True,
    known: KnownMeshes | None = None,
) -> Asset:
    """Every error of the world becomes part of the report. hashed: state the SHA-256 of the mesh
    files. known: mesh files that stay in memory. Raises SatcheckError if the baseline cannot be
    read."""
    with step(f"checking {world[0]}"):
        checked = check_asset(
            world[0],
            partial(_load, world, options, hashed, known),
            options.settings_for,
            places=options.places,
        )
    report = checked.report
    if options.baseline is not None:
        report = _beside(report, world[0], Path(options.baseline))
    return asset(world[0], replace(report, config=options.config))


def _beside(report: Report, file: str, baseline: Path) -> Report:
    known = current_baseline(baseline)
    return beside_baseline(report, known, str(baseline), (asset_key(file, baseline),))


def _load(world: World, options: CheckOptions, hashed: bool, known: KnownMeshes | None) -> Scene:
    if _is_foreign(world):
        return foreign_scene(world[0], world[1:])
    _refuse_folder(world[0])
    scene = _without_libraries(world[0], options.load(world, hashed=hashed, known=known))
    is_explained = any(issue.code in _WITHOUT_BODIES for issue in scene.issues)
    if not scene.bodies and not scene.unreadable and not is_explained:
        reason = "there is no body: give a file of rules as --rules FILE"
        raise SatcheckError("too-few-bodies", reason, file=world[0])
    return scene


def _without_libraries(file: str, scene: Scene) -> Scene:
    """A file of materials or other things without geometry is no fault among other assets."""
    lost = scene.unreadable
    if scene.bodies or any(each.issue.code != _NO_BODY or each.file != file for each in lost):
        return scene
    issues = (
        replace(each, severity="note") if each.code == _NO_BODY else each for each in scene.issues
    )
    return replace(scene, unreadable=(), order=(), issues=tuple(issues))


def _refuse_folder(name: str) -> None:
    """Only a folder that cannot be listed is among the assets, or one that does not exist."""
    if not exists(name) and not Path(name).suffix:
        raise SatcheckError("file-not-found", "no such file or folder", file=name)
    try:
        if is_folder(name):
            next(Path(name).iterdir(), None)
    except OSError as error:
        raise SatcheckError(
            "unreadable-folder", f"the folder cannot be listed: {error.strerror}", file=name
        ) from None
