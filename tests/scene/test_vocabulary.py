"""What stands in a file is read, harmless, or blocks a pass."""

from __future__ import annotations

import pytest

from satcheck.core.errors import SatcheckError
from satcheck.scene.vocabulary import Names

LINK = Names(
    frozenset({"collision", "visual", "inertial", "name"}),
    {"gazebo": "", "vendor_*": "", "*_paint_*": ""},
)


def test_what_is_read_or_harmless_is_no_issue() -> None:
    assert not list(LINK.unread(["collision", "gazebo", "vendor_x", "a_paint_b"], "line 1"))


def test_what_nobody_knows_blocks_a_pass_once() -> None:
    (message,) = LINK.unread(["fence", "fence"], "line 4: <link>")
    assert message.startswith("line 4: <link>: fence")


@pytest.mark.parametrize(
    "name", ["colision", "collison", "visaul", "inertail", "Visual", "COLLISION", "nmae"]
)
def test_a_misspelt_name_is_refused(name: str) -> None:
    with pytest.raises(SatcheckError, match=f"unknown {name} .did you mean") as error:
        list(LINK.unread([name], "line 4: <link>"))
    assert error.value.code == "misspelt"
