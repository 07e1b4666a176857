"""What `import satcheck` gives, and what it does not load."""

import inspect
import subprocess
import sys

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


def test_the_import_alone_loads_no_room() -> None:
    program = (
        "import sys, satcheck\n"
        "print([name for name in sys.modules if name.startswith(('satcheck.', 'numpy'))])"
    )
    run = subprocess.run(
        [sys.executable, "-c", program], capture_output=True, text=True, check=True
    )
    assert run.stdout == "['satcheck._version']\n"
