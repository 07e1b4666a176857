"""The check of one world of a batch, in this process. Every error becomes part of its report."""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from pathlib import Path

from msgspec.structs import replace

from satcheck.audit.acceptance import UNUSED_ACCEPTANCE
from satcheck.audit.baseline import asset_key, beside_baseline, current_baseline
from satcheck.audit.batch.options import CheckOptions, World, named_files
from satcheck.audit.bodies import UNUSED_RULE
from satcheck.audit.check import check
from satcheck.audit.messages import with_messages
from satcheck.audit.settings import Settings
from satcheck.audit.stated_places import with_stated_places
from satcheck.audit.summary import empty_report
from satcheck.core.errors import SatcheckError
from satcheck.core.steps import Loss, not_for_lack_of_memory, step
from satcheck.report.assets import Asset, asset
from satcheck.report.report import INTERNAL_ERROR, Issue, Report
from satcheck.scene import Refused, Scene
from satcheck.scene.foreign_formats import foreign_scene, is_foreign
from satcheck.scene.mesh_files import KnownMeshes
from satcheck.scene.opening import exists, is_folder, suffix_of
from satcheck.scene.words import meant

# Why a file that is as it should be has no body that can collide.
_NO_BODY = "no-body"
_WITHOUT_BODIES = ("no-collision-geometry", "not-a-body", "left-out", _NO_BODY)


def foreign_worlds(files: Mapping[str, Sequence[str]]) -> list[World]:
    """Return a world for each folder that has files which no reader knows: the folder, and these.
    Its check says that they are not read."""
    return [(folder, *names) for folder, names in files.items() if names]


def check_world(world: World, options: CheckOptions, *, known: KnownMeshes | None = None) -> Asset:
    """Check one world. If it cannot be loaded, the report has no bodies and the error as an issue.

    A world with a single body passes, and so does one without a body that can collide, or with
    pairs that rules all allow; a note says so. known: mesh files that stay in memory. Raises
    SatcheckError if the baseline cannot be read."""
    file = world[0]
    with step(f"checking {file}"):
        report = _report(world, options, known)
    if options.baseline is not None:
        report = _beside(report, world, Path(options.baseline))
    return asset(file, replace(report, config=options.config))


def _report(world: World, options: CheckOptions, known: KnownMeshes | None) -> Report:
    try:
        scene = _load(world, options, known)
        report = check(scene, options.settings_for(scene), least=0)
        return with_stated_places(report, scene)
    except SatcheckError as error:
        issues = [
            Issue(each.code, "error", None, world[0], str(each), _line_of(each))
            for each in (error, *error.others)
        ]
    except Exception as error:  # noqa: BLE001  the other worlds still get their answers
        not_for_lack_of_memory(error)
        text = f"a fault of satcheck: {type(error).__name__}: {error}"
        issues = [Issue(INTERNAL_ERROR, "error", None, world[0], text)]
    return _without_bodies(issues)


def _line_of(error: SatcheckError) -> int | None:
    return error.line if isinstance(error, Refused) else None


def _without_bodies(issues: Sequence[Issue]) -> Report:
    return with_messages(empty_report(Settings().stated(depth=False, thickness=False), issues))


def lost_asset(file: str, loss: Loss) -> Asset:
    """Return an asset whose every check lost its process: nothing is known about it."""
    message = f"{file}: the process that checked it {loss.how}"
    return asset(file, _without_bodies([Issue(loss.code, "warning", None, file, message)]))


def unreadable_asset(file: str, error: SatcheckError) -> Asset:
    """Return an asset whose result cannot be read."""
    return asset(file, _without_bodies([Issue(error.code, "error", None, file, str(error))]))


def beside_assets(issue: Issue) -> Asset:
    """Return what stands for an issue about a whole batch among its assets."""
    return asset(issue.file or "the batch", _without_bodies([issue]))


def _beside(report: Report, world: World, baseline: Path) -> Report:
    known, name = current_baseline(baseline), asset_key(named_files(world), baseline)
    return beside_baseline(report, known, str(baseline), (name,))


def _load(world: World, options: CheckOptions, known: KnownMeshes | None) -> Scene:
    if len(world) > 1 and is_folder(world[0]) and all(map(is_foreign, world[1:])):
        return foreign_scene(world[0], world[1:])
    _refuse_folder(world[0])
    scene = _without_libraries(world[0], options.load(world, known=known))
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
    try:
        if is_folder(name):
            next(Path(name).iterdir(), None)
        elif not suffix_of(name) and not exists(name):
            parent = Path(name).parent
            near = meant(
                Path(name).name, [p.name for p in parent.iterdir()] if parent.is_dir() else ()
            )
            raise SatcheckError("file-not-found", f"no such file or folder{near}", file=name)
    except OSError as error:
        raise SatcheckError(
            "unreadable-folder", f"the folder cannot be listed: {error.strerror}", file=name
        ) from None


def without_unused_rules(given: Asset, files: Collection[str]) -> tuple[Asset, tuple[Issue, ...]]:
    """Return the asset without the issues of rules in these files that select no pair, and these:
    such rules are about many assets, and need not be about this one. An asset that could not be
    loaded may need them."""
    unused = tuple(i for i in given.report.issues if _is_unused_rule(i, files))
    if not unused:
        return given, ()
    issues = tuple(i for i in given.report.issues if i not in unused)
    kept = asset(given.file, replace(given.report, issues=issues))
    return kept, unused if given.report.bodies else ()


def _is_unused_rule(issue: Issue, files: Collection[str]) -> bool:
    """An acceptance that accepts nothing counts as one."""
    of_files = issue.code == UNUSED_RULE and issue.file in files
    return of_files or issue.code == UNUSED_ACCEPTANCE
