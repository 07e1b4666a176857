"""Options of readers: how they are given, what a report states of them, and that they travel."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import pytest
from msgspec import Meta
from msgspec.structs import replace

from satcheck.audit.batch.key import terms_of
from satcheck.audit.batch.options import CheckOptions
from satcheck.core.errors import SatcheckError
from satcheck.scene import load_scene
from satcheck.scene.errors import Refused
from satcheck.scene.files.readers import Option, Reader, facets, option_named, stated_options
from satcheck.scene.issue import CODES
from tests.cli.process import SAMPLES, satcheck
from tests.plugin_marks import needs

CHORD, ANGLE = facets(1.0)


@needs("usd")
def test_the_given_options_are_stated() -> None:
    assert stated_options({"time": 2.5}, ["obj", "usd"]) == {"time": 2.5}
    assert stated_options({}, ["usd", "obj"]) is None


@needs("step")
@needs("ifc")
def test_a_default_is_stated_if_the_formats_agree_on_it() -> None:
    step = {"chord_tolerance": 0.005, "angular_tolerance": 0.5}
    assert stated_options({}, ["step"]) == step
    assert stated_options({}, ["step", "ifc"]) == {"angular_tolerance": 0.5}
    assert stated_options({"chord_tolerance": 2.0}, ["step", "ifc"]) == {
        "chord_tolerance": 2.0,
        "angular_tolerance": 0.5,
    }


@pytest.mark.parametrize(
    ("text", "value"), [("0.25", 0.25), ("0.25mm", 0.25), ("1cm", 10.0), ("1e-3", 0.001)]
)
def test_a_length_is_in_millimetres_or_has_a_unit(text: str, value: float) -> None:
    assert CHORD.parsed(text) == value


@pytest.mark.parametrize("text", ["0", "-1", "inf", "nan", "", "wide", "1 parsec"])
def test_a_value_that_an_option_does_not_take_is_refused(text: str) -> None:
    is_word = text in ("", "wide", "1 parsec")
    fit = "a number" if is_word else "another value"
    with pytest.raises(SatcheckError, match=f"chord-tolerance should be {fit}"):
        CHORD.parsed(text)
    with pytest.raises(SatcheckError, match=f"angular-tolerance should be {fit}"):
        ANGLE.parsed(text)


@needs("usd")
def test_a_list_of_words_has_commas() -> None:
    purpose = option_named("purpose")
    assert purpose.parsed("proxy,guide") == ("proxy", "guide")
    assert purpose.converted(["proxy"]) == ("proxy",)
    with pytest.raises(SatcheckError, match="render"):
        purpose.parsed("proxy,gide")


def test_a_result_of_a_batch_depends_on_them() -> None:
    options = CheckOptions()
    assert terms_of(options) != terms_of(replace(options, reading={"time": 2.5}))


@needs("usd")
def test_a_scene_states_what_is_not_given(tmp_path: Path) -> None:
    for name, time in (("a", 1), ("b", 2)):
        text = f'schema = "satcheck.scene/1"\nreading.time = {time}\nbodies = []\n'
        (tmp_path / f"{name}.toml").write_text(text)
    assert load_scene([tmp_path / "a.toml"]).reading == {"time": 1}
    assert load_scene([tmp_path / "a.toml"], reading={"time": 5}).reading == {"time": 5}
    with pytest.raises(Refused, match="differs"):
        load_scene([tmp_path / "a.toml", tmp_path / "b.toml"])


def test_an_option_that_no_reader_has_is_refused(tmp_path: Path) -> None:
    with pytest.raises(SatcheckError, match=r"no reader has the option flop; there are .*geometry"):
        load_scene([SAMPLES / "box.obj"], reading={"flop": 1})
    (tmp_path / "a.toml").write_text('schema = "satcheck.scene/1"\nreading.flop = 1\nbodies = []\n')
    with pytest.raises(Refused, match="unknown key"):
        load_scene([tmp_path / "a.toml"])


@needs("step")
def test_an_option_without_effect_is_told(tmp_path: Path) -> None:
    meshes = str(SAMPLES / "box.obj"), str(SAMPLES / "box_flush.stl")
    given = ("--read", "chord-tolerance=1mm")
    ran = satcheck(*given, *meshes)
    assert ran.code == 2
    assert "no reader of these files has the option chord-tolerance: they have none" in ran.err
    # Where the option may be about other files, a note says so.
    (tmp_path / "satcheck.toml").write_text('read = ["chord-tolerance=1mm"]\n')
    config = ("--config", str(tmp_path / "satcheck.toml"), "--format", "json")
    codes = [issue["code"] for issue in satcheck(*config, *meshes).document["issues"]]
    assert "unused-option" in codes
    scene = load_scene(meshes, reading={"chord-tolerance": 1.0})
    assert [issue.code for issue in scene.issues] == ["unused-option"]
    assert scene.reading == {"chord_tolerance": 1.0}


@pytest.mark.parametrize(
    ("given", "said"),
    [
        (["flop=1"], "no reader has the option flop; there are"),
        (["time"], "should be NAME=VALUE"),
        (["geometry=visual"], "--geometry gives the geometry"),
        pytest.param(
            ["chord-tolerance=1", "chord_tolerance=2"], "given twice", marks=needs("step")
        ),
        pytest.param(
            ["chord-tolerance=0"],
            "should be another value (how far facets may be off, in millimetres, above 0), not '0'",
            marks=needs("step"),
        ),
        (["=1"], "'=1' should be NAME=VALUE"),
        pytest.param(
            ["purpos=render"], "has the option purpos (did you mean 'purpose'?)", marks=needs("usd")
        ),
        pytest.param(
            ["purpose=rend"],
            "purpose should be one of render, proxy, guide, or several with commas, not 'rend'",
            marks=needs("usd"),
        ),
        pytest.param(
            ["mesh-hulls=maybe"],
            "mesh-hulls should be true or false, not 'maybe'",
            marks=needs("mjcf"),
        ),
    ],
)
def test_what_is_wrong_on_the_command_line_is_said(given: list[str], said: str) -> None:
    words = [word for each in given for word in ("--read", each)]
    ran = satcheck(*words, str(SAMPLES / "box.obj"), str(SAMPLES / "box_flush.stl"))
    assert ran.code == 2
    assert said in " ".join(ran.err.split())


def test_a_value_that_only_another_reader_takes_is_refused_for_the_file() -> None:
    narrow = Option("purpose", Annotated[float, Meta(gt=0)], "a number")
    reader = Reader("toy", "TOY", (".toy",), "toy:read", options=(narrow,))
    with pytest.raises(Refused, match="TOY: purpose should be") as refused:
        reader.values({"purpose": "render"})
    assert refused.value.code in CODES
