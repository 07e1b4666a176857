"""The findings of pairs: what survives the failure of one."""

from __future__ import annotations

from satcheck.audit import check, checked_pairs
from tests.audit.shapes import scene_of, unit_box


def test_a_failing_pair_does_not_take_the_others_with_it(tmp_path, monkeypatch, caplog):
    original = checked_pairs.examine

    def failing(draft, climb):
        if draft.pair.a.id == "b":
            raise ZeroDivisionError("made up")
        return original(draft, climb)

    monkeypatch.setattr(checked_pairs, "examine", failing)
    caplog.set_level("DEBUG", logger="satcheck")
    report = check(scene_of(tmp_path, a=unit_box(), b=unit_box(0.75), c=unit_box(1.5)))
    assert [(f.a, f.b, f.relation) for f in report.findings] == [
        ("a", "b", "penetrating"),
        ("a", "c", "separated"),
        ("b", "c", "indeterminate"),
    ]
    assert [issue.code for issue in report.issues] == ["internal-error"]
    assert "made up" in caplog.text
