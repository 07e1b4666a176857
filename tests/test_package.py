"""What `import satcheck` gives, and what it does not load."""

import inspect
import pydoc
import re
import subprocess
import sys
from pathlib import Path

import pytest

import satcheck


def test_the_names_are_there() -> None:
    for name in satcheck.__all__:
        assert getattr(satcheck, name) is not None
        assert name in dir(satcheck)


def test_a_name_that_does_not_exist_is_an_attribute_error() -> None:
    with pytest.raises(AttributeError, match="module 'satcheck' has no attribute 'collide'"):
        _ = satcheck.collide


@pytest.mark.parametrize("name", ["check", "check_meshes", "load_scene", "scene_of_meshes"])
def test_a_function_has_a_signature_and_a_page(name: str) -> None:
    function = getattr(satcheck, name)
    assert inspect.signature(function).parameters
    assert len(inspect.getdoc(function) or "") > 200


@pytest.mark.parametrize("name", [None, *(n for n in satcheck.__all__ if n != "__version__")])
def test_help_prints_a_page(name: str | None) -> None:
    assert pydoc.render_doc(satcheck if name is None else getattr(satcheck, name))


def test_the_core_needs_no_import_of_its_own() -> None:
    program = "import satcheck; print(satcheck.core.check_pair.__name__)"
    run = subprocess.run(
        [sys.executable, "-c", program], capture_output=True, text=True, check=True
    )
    assert run.stdout == "check_pair\n"


@pytest.mark.parametrize(
    "wrong",
    [
        {"depth": "no"},
        {"tolerance": True},
        {"volume": "x"},
        {"part_seconds": -1.0},
        {"budget": "a"},
        {"jobs": 1.5},
    ],
)
def test_a_setting_of_another_type_is_refused_by_name(wrong: dict[str, object]) -> None:
    (name,) = wrong
    with pytest.raises(satcheck.SatcheckError, match=name):
        satcheck.Settings(**wrong)


def test_a_dict_is_no_settings() -> None:
    with pytest.raises(satcheck.SatcheckError, match=r"satcheck\.Settings"):
        satcheck.check(["a.obj", "b.obj"], {"tolerance": 0.0})


def test_the_import_alone_loads_no_room() -> None:
    program = (
        "import sys, satcheck\n"
        "print([name for name in sys.modules if name.startswith(('satcheck.', 'numpy'))])"
    )
    run = subprocess.run(
        [sys.executable, "-c", program], capture_output=True, text=True, check=True
    )
    assert run.stdout == "['satcheck._version']\n"


def test_the_action_runs_no_code_of_the_checked_repository() -> None:
    """`python -m` finds modules in the current folder, unless it is isolated."""
    action = (Path(__file__).parents[1] / "action.yml").read_text(encoding="utf-8")
    before = re.findall(r"(\S+) -m (?:venv|pip)\b", action)
    assert before == ["-I", "-I"]
    script = action.partition("runs:")[2]
    assert "${{ inputs." not in "".join(re.findall(r"run: \|\n((?: {8}.*\n)+)", script))
