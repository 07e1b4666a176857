"""The samples give their golden reports byte for byte, and the truth that index.json states."""

from __future__ import annotations

import importlib
import json
from functools import cache
from typing import Any

import pytest

from tests.cli.process import VALIDATOR
from tests.golden import HERE, INDEX, PAIRS, SAMPLE_CALLS, SAMPLES, SCENES, golden_file, report
from tests.plugin_marks import skip_without

NAMES = list(PAIRS)
# Truth is stated in decimals; the samples' sizes are between 1 and 20.
ROUNDING = 1e-9


@cache
def answer(name: str) -> tuple[int, bytes]:
    skip_without(SAMPLE_CALLS[name]["inputs"])
    return report(name)


def finding(name: str) -> dict[str, Any]:
    (only,) = json.loads(answer(name)[1])["findings"]
    return dict(only)


@pytest.mark.parametrize("name", SAMPLE_CALLS)
def test_report_is_the_golden_one(name: str) -> None:
    assert answer(name)[1] == golden_file(name).read_bytes(), "see `make golden`"


@pytest.mark.parametrize("name", SAMPLE_CALLS)
def test_report_follows_the_schema(name: str) -> None:
    VALIDATOR.validate(json.loads(answer(name)[1]))


@pytest.mark.parametrize("name", NAMES)
def test_relation_and_exit_code_are_true(name: str) -> None:
    truth = PAIRS[name]
    assert finding(name)["relation"] == truth["relation"]
    assert answer(name)[0] == truth["exit"]


@pytest.mark.parametrize("name", [name for name in NAMES if PAIRS[name]["depth"] is not None])
def test_depth_is_true(name: str) -> None:
    found, depth = finding(name), PAIRS[name]["depth"]
    low, high = found["depth_bounds"]
    assert low - ROUNDING <= depth <= high + ROUNDING
    if found["quality"] == "exact":
        assert found["depth"] == pytest.approx(depth, abs=ROUNDING)
        assert high - low < ROUNDING
    else:
        assert found["quality"] == "bounded"
        assert found["depth"] == high


@pytest.mark.parametrize("name", [name for name in NAMES if PAIRS[name]["mtv"] is not None])
def test_the_way_out_is_verified_and_true(name: str) -> None:
    """Exact pairs move by the true vector; bounded ones by no more than the bound allows."""
    found, mtv = finding(name), PAIRS[name]["mtv"]
    assert found["mtv_verified"] is True
    if found["quality"] == "exact":
        assert found["mtv"] == pytest.approx(mtv, abs=ROUNDING)
    else:
        length = sum(c * c for c in found["mtv"]) ** 0.5
        assert length >= PAIRS[name]["depth"] - ROUNDING


@pytest.mark.parametrize("name", [name for name in NAMES if "distance" in PAIRS[name]])
def test_distance_is_true(name: str) -> None:
    assert finding(name)["distance"] == pytest.approx(PAIRS[name]["distance"], abs=ROUNDING)


@pytest.mark.parametrize("name", [name for name in NAMES if "contact_length" in PAIRS[name]])
def test_contacts_are_true(name: str) -> None:
    totals = finding(name)["contacts"]["totals"]
    assert totals["length"] == pytest.approx(PAIRS[name]["contact_length"], abs=ROUNDING)
    assert totals["area"] == pytest.approx(PAIRS[name]["contact_area"], abs=ROUNDING)


@pytest.mark.parametrize("name", SCENES)
def test_the_findings_of_a_scene_are_true(name: str) -> None:
    code, document = answer(name)
    assert code == SCENES[name]["exit"]
    found = {(f["a"], f["b"]): f for f in json.loads(document)["findings"]}
    for a, b, relation, depth in SCENES[name]["findings"]:
        finding = found.pop((a, b))
        assert finding["relation"] == relation, (a, b)
        if depth is not None:
            low, high = finding["depth_bounds"]
            assert low - ROUNDING <= depth <= high + ROUNDING
    assert {finding["relation"] for finding in found.values()} <= {"separated"}


@pytest.mark.parametrize("name", ["fin", "open", "inside_out"])
def test_unhealthy_meshes_come_with_a_warning(name: str) -> None:
    issues = json.loads(answer(name)[1])["issues"]
    assert any(issue["severity"] == "warning" for issue in issues)


def test_every_golden_report_belongs_to_a_pair_or_scene() -> None:
    assert {file.stem for file in HERE.glob("*.json")} == set(SAMPLE_CALLS)


def test_every_mesh_has_its_sentence() -> None:
    meshes = {file.name for file in SAMPLES.iterdir() if file.suffix not in (".py", ".json")}
    assert meshes - {"__pycache__"} == set(INDEX["meshes"])
    inputs = {name for call in SAMPLE_CALLS.values() for name in call["inputs"]}
    assert {name for name in inputs if not name.startswith("../docs/")} <= meshes


@pytest.mark.parametrize("maker", ["make", "kitchen", "hierarchies"])
def test_the_generators_write_the_committed_bytes(maker: str) -> None:
    for name, content in importlib.import_module(f"sample_meshes.{maker}").samples().items():
        assert (SAMPLES / name).read_bytes() == content, name
