"""Options of reading: what a report states of them, and that they travel."""

from __future__ import annotations

from pathlib import Path

import pytest
from msgspec.structs import replace

from satcheck.audit.batch.key import terms_of
from satcheck.audit.batch.options import CheckOptions
from satcheck.scene import load_scene
from satcheck.scene.errors import Refused
from satcheck.scene.files.readers import readers, stated_options
from satcheck.scene.read_options import ReadOptions, as_stated
from tests.plugin_marks import needs


@needs("usd")
def test_only_the_options_of_the_formats_that_occur_are_stated() -> None:
    options = ReadOptions(time=2.5)
    assert stated_options(options, ["obj", "glb"]) is None
    assert stated_options(options, ["obj", "usd"]) == {
        "time": 2.5,
        "geometry": None,
        "purpose": None,
    }


def test_a_default_without_effect_is_not_stated() -> None:
    assert stated_options(ReadOptions(), ["usd"]) is None


@needs("usd")
def test_the_options_of_a_report_are_those_of_its_check() -> None:
    options = ReadOptions(time=2.5)
    formats = [reader.name for reader in readers().values()]
    assert as_stated(stated_options(options, formats)) == options
    assert as_stated(None) == ReadOptions()


def test_a_result_of_a_batch_depends_on_them() -> None:
    options = CheckOptions()
    assert terms_of(options) != terms_of(replace(options, reading=ReadOptions(time=2.5)))


def test_a_scene_states_what_is_not_given(tmp_path: Path) -> None:
    for name, time in (("a", 1), ("b", 2)):
        text = f'schema = "satcheck.scene/1"\nreading.time = {time}\nbodies = []\n'
        (tmp_path / f"{name}.toml").write_text(text)
    assert load_scene([tmp_path / "a.toml"]).reading.time == 1
    assert load_scene([tmp_path / "a.toml"], reading=ReadOptions(time=5)).reading.time == 5
    with pytest.raises(Refused, match="differs"):
        load_scene([tmp_path / "a.toml", tmp_path / "b.toml"])
