"""The findings of a report as a table: a row for each, a single value in each cell."""

from __future__ import annotations

from typing import TYPE_CHECKING

from satcheck.core.errors import SatcheckError
from satcheck.report.verdict import is_failure, severity

if TYPE_CHECKING:
    import pandas

    from satcheck.report.report import Finding, Report
    from satcheck.report.values import Vector

TEXT, NUMBER, TRUTH = "object", "float64", "boolean"
# Columns, and what is in them. Lower ends are those of proven intervals, with the figure as upper
# end. Lengths are in the units of the report. impact: of bodies that hit while they move, the time
# of a `Sweep`, its point, and the numbers of the poses before and after it.
COLUMNS = {
    **dict.fromkeys(("a", "b", "relation", "severity"), TEXT),
    "fails": "bool",
    "undecided": TEXT,
    **dict.fromkeys(("thickness", "thickness_lower", "depth", "depth_lower"), NUMBER),
    **dict.fromkeys(("distance", "distance_lower", "volume", "volume_error"), NUMBER),
    **dict.fromkeys(("mtv_x", "mtv_y", "mtv_z"), NUMBER),
    "mtv_verified": TRUTH,
    **dict.fromkeys(("normal_x", "normal_y", "normal_z"), NUMBER),
    **dict.fromkeys((f"witness_{body}_{axis}" for body in "ab" for axis in "xyz"), NUMBER),
    "tolerance": NUMBER,
    "placed_relation": TEXT,
    **dict.fromkeys(("impact_time", "impact_time_lower"), NUMBER),
    **dict.fromkeys(("impact_x", "impact_y", "impact_z"), NUMBER),
    **dict.fromkeys(("impact_pose_before", "impact_pose_after"), NUMBER),
    **dict.fromkeys(("exact_relation", "quality", "rule", "baseline"), TEXT),
    **dict.fromkeys(("reason", "message", "id"), TEXT),
}


def row_of(finding: Finding, report: Report) -> dict[str, str | float | bool | None]:
    """Return the value of each column; None: not known, not asked, or it does not apply."""
    lower = {
        f"{figure}_lower": bounds and bounds[0]
        for figure, bounds in (
            ("thickness", finding.thickness_bounds),
            ("depth", finding.depth_bounds),
            ("distance", finding.distance_bounds),
        )
    }
    witness, motion = finding.witness, finding.motion
    vectors = {
        **_parts("mtv", finding.mtv),
        **_parts("normal", finding.normal),
        **_parts("witness_a", witness.a if witness else None),
        **_parts("witness_b", witness.b if witness else None),
        **_parts("impact", motion.point if motion else None),
    }
    times = (motion and motion.time_of_impact) or (None, None)
    poses = (motion and motion.poses) or (None, None)
    impact = {
        "impact_time": times[1],
        "impact_time_lower": times[0],
        "impact_pose_before": poses[0],
        "impact_pose_after": poses[1],
    }
    verdict = {
        "severity": severity(finding),
        "fails": is_failure(finding, report.settings.fail_on),
        "baseline": finding.baseline_state,
    }
    derived = {**lower, **vectors, **impact, **verdict}
    return {name: derived[name] if name in derived else getattr(finding, name) for name in COLUMNS}


def _parts(name: str, vector: Vector | None) -> dict[str, float | None]:
    return dict(zip((f"{name}_{axis}" for axis in "xyz"), vector or (None,) * 3, strict=True))


def dataframe_of(report: Report) -> pandas.DataFrame:
    """Return the rows as a pandas.DataFrame, in the order of the findings; a number that is None is
    NaN. Raises SatcheckError `missing-extra` without pandas."""
    try:
        import pandas
    except ImportError:
        message = "a data frame needs pandas: pip install pandas"
        raise SatcheckError("missing-extra", message) from None
    rows = [row_of(finding, report) for finding in report.findings]
    return pandas.DataFrame(rows, columns=list(COLUMNS)).astype(COLUMNS)
