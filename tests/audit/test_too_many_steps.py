"""What the core does not decide within its budget is a clear answer of one pair, or of one mesh."""

from __future__ import annotations

from typing import NoReturn

import pytest

from satcheck import core
from satcheck.audit import checked_pairs
from satcheck.audit.check import check
from satcheck.audit.settings import Settings
from satcheck.audit.stages.relation import TOO_MANY_STEPS
from satcheck.report.report import INTERNAL_ERROR
from satcheck.scene import load_scene
from satcheck.scene.errors import Refused
from satcheck.scene.inspect import ErrorsOf


def spent(*_: object) -> NoReturn:
    raise core.TooManySteps("the query takes more steps than it may")


def test_a_pair_beyond_the_budget_is_indeterminate(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(checked_pairs, "examine", spent)
    pair = ["sample_meshes/box_flush.stl", "sample_meshes/box_pushed.stl"]
    report = check(load_scene(pair), Settings())
    answers = [(finding.relation, finding.reason) for finding in report.findings]
    assert answers == [("indeterminate", TOO_MANY_STEPS)]
    assert INTERNAL_ERROR not in {issue.code for issue in report.issues}


def test_a_mesh_beyond_the_budget_is_refused() -> None:
    with pytest.raises(Refused) as refused, ErrorsOf("knot.obj"):
        spent()
    assert (refused.value.code, refused.value.file) == ("too-many-steps", "knot.obj")
