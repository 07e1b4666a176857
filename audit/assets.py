"""Checks one asset as a scene of its own. Every error becomes part of its report."""

from __future__ import annotations

from collections.abc import Callable, Collection, Sequence

from msgspec.structs import replace

from satcheck.audit.acceptance import UNUSED_ACCEPTANCE
from satcheck.audit.bodies import UNUSED_RULE
from satcheck.audit.check import check
from satcheck.audit.messages import with_messages
from satcheck.audit.settings import Settings
from satcheck.audit.stated_places import with_stated_places
from satcheck.audit.summary import tool
from satcheck.core.errors import SatcheckError
from satcheck.core.risky_steps import Loss, not_for_lack_of_memory
from satcheck.report.assets import Asset, asset
from satcheck.report.report import (
    INTERNAL_ERROR,
    Issue,
    PairCounts,
    Report,
)
from satcheck.report.verdict import summarise
from satcheck.scene import Refused, Scene

NO_PAIRS = PairCounts(total=0, pruned=0, decided=0, allowed=0, indeterminate=0)


def check_asset(
    file: str,
    load: Callable[[], Scene],
    settings_for: Callable[[Scene], Settings],
    *,
    places: bool = False,
) -> Asset:
    """Checks one asset. If it cannot be loaded, the report has no bodies and the error as an issue.

    An asset with a single body passes, and so does one without a body that can collide, or with
    pairs that rules all allow; a note says so. settings_for: makes the settings for a scene,
    because lengths may be in its units.
    places: state where scene files name the bodies of findings.
    """
    try:
        scene = load()
        report = check(scene, settings_for(scene), least=0)
        return asset(file, with_stated_places(report, scene) if places else report)
    except SatcheckError as error:
        issues = [
            Issue(each.code, "error", None, file, str(each), _line_of(each))
            for each in (error, *error.others)
        ]
    except Exception as error:  # noqa: BLE001  the other assets still get their answers
        not_for_lack_of_memory(error)
        text = f"a fault of satcheck: {type(error).__name__}: {error}"
        issues = [Issue(INTERNAL_ERROR, "error", None, file, text)]
    return asset(file, _without_bodies(issues))


def lost_asset(file: str, loss: Loss) -> Asset:
    """An asset whose every check lost its process: nothing is known about it."""
    message = f"{file}: the process that checked it {loss.how}"
    return asset(file, _without_bodies([Issue(loss.code, "warning", None, file, message)]))


def unreadable_asset(file: str, error: SatcheckError) -> Asset:
    """An asset whose result cannot be read."""
    return asset(file, _without_bodies([Issue(error.code, "error", None, file, str(error))]))


def _line_of(error: SatcheckError) -> int | None:
    return error.line if isinstance(error, Refused) else None


def unused_rules(assets: Sequence[Asset], files: Collection[str]) -> tuple[Issue, ...]:
    """The issues of rules in these files that select no pair in any asset. An asset that could not
    be loaded may need them."""
    if not assets or any(not asset.report.bodies for asset in assets):
        return ()
    first, *others = (asset.report.issues for asset in assets)
    unused = (issue for issue in first if _is_unused_rule(issue, files))
    return tuple(issue for issue in unused if all(issue in issues for issues in others))


def without_unused_rules(given: Asset, files: Collection[str]) -> Asset:
    """Rules in these files are about many assets, and need not be about this one."""
    issues = tuple(i for i in given.report.issues if not _is_unused_rule(i, files))
    return asset(given.file, replace(given.report, issues=issues))


def _is_unused_rule(issue: Issue, files: Collection[str]) -> bool:
    """An acceptance that accepts nothing counts as one."""
    of_files = issue.code == UNUSED_RULE and issue.file in files
    return of_files or issue.code == UNUSED_ACCEPTANCE


def _without_bodies(issues: list[Issue]) -> Report:
    settings = Settings()
    report = Report(
        tool=tool(),
        units=None,
        settings=settings.stated(depth=False, thickness=False),
        summary=summarise(NO_PAIRS, (), settings.fail_on),
        bodies=(),
        findings=(),
        issues=tuple(issues),
    )
    return with_messages(report)
