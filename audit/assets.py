"""The check of one asset as a scene of its own, whatever is wrong with it."""

from __future__ import annotations

from collections.abc import Callable

from satcheck.audit.check import check
from satcheck.audit.request.settings import Settings
from satcheck.audit.summary import summarise, tool
from satcheck.core.errors import SatcheckError
from satcheck.report.assets import Asset, asset
from satcheck.report.report import INTERNAL_ERROR, Issue, PairCounts, Report
from satcheck.scene import Scene

NO_PAIRS = PairCounts(total=0, pruned=0, decided=0, allowed=0, indeterminate=0)


def check_asset(
    file: str, load: Callable[[str], Scene], settings_for: Callable[[Scene], Settings]
) -> Asset:
    """An asset that cannot be loaded has a report without bodies, with the error as an issue.

    One body alone passes: it has nothing to collide with, and the report has the issues of its
    mesh. settings_for: lengths may be in the units of the scene.
    """
    try:
        scene = load(file)
        return asset(file, check(scene, settings_for(scene), least=1))
    except SatcheckError as error:
        issues = [
            Issue(each.code, "error", None, file, str(each)) for each in (error, *error.others)
        ]
    except Exception as error:  # noqa: BLE001  the other assets still get their answers
        text = f"a fault of satcheck: {type(error).__name__}: {error}"
        issues = [Issue(INTERNAL_ERROR, "error", None, file, text)]
    return asset(file, _without_bodies(issues))


def _without_bodies(issues: list[Issue]) -> Report:
    settings = Settings()
    return Report(
        tool=tool(),
        units=None,
        settings=settings.stated(depth=False, thickness=False),
        summary=summarise(NO_PAIRS, (), settings.fail_on),
        bodies=(),
        findings=(),
        issues=tuple(issues),
    )
