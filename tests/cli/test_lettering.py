"""Letters in an image, the caption and the labels."""

from __future__ import annotations

import string

import numpy as np
import pytest

from satcheck.audit import Settings, check
from satcheck.cli.formats.picture.lettering import _STROKE, _STROKES, plain, width_of, write
from satcheck.cli.formats.picture.moments import Moments
from satcheck.cli.formats.picture.png import BAND, FORCE, INK, KINDS, View, _label, render
from satcheck.cli.formats.picture.shown import Label, Shows
from satcheck.scene.meshes import scene_of_meshes
from tests.cli.test_png import image_of, near, pixels
from tests.cli.test_viewpoint import box

BLACK = (0.0, 0.0, 0.0)


def written(text: str) -> np.ndarray:
    image = np.full((40, 400, 3), 255, np.uint8)
    write(image, text, 5.0, 30.0, 20.0, BLACK)
    return image


def test_every_printable_letter_has_strokes_of_points() -> None:
    assert set(string.printable) - set(string.whitespace) <= set(_STROKES)
    for letter, strokes in _STROKES.items():
        assert all(len(stroke) % 2 == 0 for stroke in strokes.split()), letter
    ink = [written(letter).tobytes() for letter in string.ascii_letters + string.digits]
    assert len(set(ink)) == len(ink)


def test_letters_stay_within_their_width() -> None:
    text = "thickness 0.5 mm"
    columns = np.flatnonzero((written(text) < 255).any(axis=(0, 2)))
    around = _STROKE * 20.0 / 2 + 1.0  # half a stroke, and a pixel that it shares
    assert 5 - around <= columns[0] < 5 + 20.0
    assert columns[-1] < 5 + width_of(text, 20.0) + around


def test_accents_are_lost_and_other_writing_is_boxes() -> None:
    assert plain("Träger é") == "Trager e"
    assert (written("ä") == written("a")).all()
    assert (written("中") == written("文")).all()
    assert (written("中") < 255).any()


def test_what_is_beyond_the_image_is_left_out() -> None:
    image = np.full((10, 10, 3), 255, np.uint8)
    write(image, "abc", -50.0, 500.0, 20.0, BLACK)
    assert (image == 255).all()


def test_the_caption_is_below_the_picture() -> None:
    image = image_of("box.obj", "box_pushed.stl")
    band = image[-40:]
    assert near(band, BAND, 0.01).mean() > 0.5
    assert near(band, INK).any()


def test_long_names_end_within_the_image() -> None:
    """The caption has both on one line; the letters of a label have its colour beside them."""
    names = [letter * 60 for letter in "HM"]
    scene = scene_of_meshes({n: box((1, 1, 1), (k / 2, 0, 0)) for k, n in enumerate(names)})
    image = pixels(render(check(scene, Settings(depth=True)), scene, (400, 300)))
    assert not near(image[:, -2:], INK).any()
    assert near(image, INK).sum() > 300


def test_labels_that_meet_stay_within_the_image() -> None:
    """They stand below each other, and at the lower edge above."""
    image = np.ones((60, 100, 3), np.uint8)
    bodies = (box((1, 1, 1), (0, 0, 0)), box((1, 1, 1), (0.5, 0, 0)))
    scene = scene_of_meshes(dict(zip("ab", bodies, strict=True)))
    shown = Shows(check(scene), scene, Moments(), "z").of(check(scene).findings[0])
    labels = [Label(text, np.zeros(3), "gap") for text in ("one", "two", "six")]
    view = View(np.eye(3), np.zeros(3), 1.0, (10.0, 58.0))
    _label(image, shown._replace(labels=labels), view)
    strip = np.array(KINDS[FORCE].colour) * 255.0
    rows = (abs(image - strip).max(axis=2) < 1.0).any(axis=1)
    assert rows.sum() >= 12 * len(labels)


@pytest.mark.parametrize("inner", ["a", "b"])
def test_a_contained_body_is_red_as_on_the_page(inner: str) -> None:
    """Through a crowd of other bodies, too."""
    large, small = box((4, 4, 4), (0, 0, 0)), box((1, 1, 1), (0, 0, 0))
    pair = {"a": small, "b": large} if inner == "a" else {"a": large, "b": small}
    screens = {f"screen {k}": box((9, 9, 0.1), (0, 0, 3 + k)) for k in range(6)}
    scene = scene_of_meshes(pair | screens)
    image = pixels(render(check(scene, Settings(depth=False)), scene, (400, 300)))
    red = (image[..., 0] > 0.4) & (image[..., 1:] < 0.35).all(axis=2)
    assert red.mean() > 0.005
