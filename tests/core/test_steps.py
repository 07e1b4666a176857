"""The steps that are under way, for whoever shows progress."""

from __future__ import annotations

import time

import pytest

from satcheck.core.steps import current, step, step_in_words


def test_the_step_that_began_last_is_current() -> None:
    with step("outer"):
        with step("inner"):
            assert current() == "inner"
        assert current() == "outer"
    assert current() == ""


def test_a_step_with_a_limit_says_how_much_of_it_is_left(monkeypatch: pytest.MonkeyPatch) -> None:
    now = 100.0
    monkeypatch.setattr(time, "monotonic", lambda: now)
    with step("splitting kettle", 60.0):
        now = 117.4
        assert current() == "splitting kettle, at most 43 s left"
        now = 161.0
        assert current() == "splitting kettle, at most 0 s left"


def test_a_step_in_words_is_shown_from_its_first_words_on() -> None:
    with step("outer"), step_in_words() as say:
        assert current() == "outer"
        say("a quarter")
        assert current() == "a quarter"
        say("half")
        assert current() == "half"
    assert current() == ""


def test_of_several_the_one_that_began_last_is_current() -> None:
    """So that two searches side by side do not take turns."""
    with step_in_words() as say, step_in_words() as say_too:
        say_too("half")
        say("half")
        say_too("most")
        assert current() == "half"
        say("most")
        assert current() == "most"
    assert current() == ""


def fail_after_words() -> None:
    with step_in_words() as say:
        say("half")
        raise ValueError("no")


def test_a_step_that_fails_is_no_longer_under_way() -> None:
    with pytest.raises(ValueError, match="no"):
        fail_after_words()
    assert current() == ""
