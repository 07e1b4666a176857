"""How large an SVG drawing is, and in what unit."""

from __future__ import annotations

import pytest

from satcheck.scene.drawing.contour import DrawnShape
from satcheck.scene.drawing.svg import read_svg
from satcheck.scene.errors import MeshFileError

BOX = 'viewBox="0 0 200 100"'


def square(head: str) -> tuple[str | None, tuple[float, float]]:
    """The unit, and the far corner of a square of 10 user units."""
    text = f'<svg xmlns="http://www.w3.org/2000/svg" {head}><rect width="10" height="10"/></svg>'
    drawing = read_svg(text.encode())
    (shape,) = drawing.shapes
    assert isinstance(shape, DrawnShape)
    return drawing.units, max(shape.contours[0].points)


@pytest.mark.parametrize(
    ("head", "units", "corner"),
    [
        (f'width="200mm" height="100mm" {BOX}', "mm", (10, 10)),
        (f'width="200mm" height="50mm" {BOX}', "mm", (5, 5)),
        (f'width="100mm" height="100mm" {BOX} preserveAspectRatio="xMinYMax meet"', "mm", (5, 5)),
        (f'width="200mm" height="50mm" {BOX} preserveAspectRatio="xMidYMid slice"', "mm", (10, 10)),
        (f'width="200mm" height="50mm" {BOX} preserveAspectRatio="none"', "mm", (10, 5)),
        (f'width="20cm" {BOX}', "cm", (1, 1)),
        (f'height="20in" {BOX}', "in", (2, 2)),
        (f'width="20cm" height="auto" {BOX} preserveAspectRatio="none"', "cm", (1, 1)),
        (f'width="144pt" {BOX}', "in", (0.1, 0.1)),
        (f'width="12pc" {BOX}', "in", (0.1, 0.1)),
        (f'width="20cm" height="50mm" {BOX}', "cm", (0.5, 0.5)),
        (f'width="96" height="10in" {BOX}', "in", (0.05, 0.05)),
    ],
)
def test_a_size_with_a_unit_is_that_of_the_view_box(
    head: str, units: str, corner: tuple[float, float]
) -> None:
    found, far = square(head)
    assert found == units
    assert far == pytest.approx(corner, rel=2.0**-50)


def test_points_of_a_hundredth_inch() -> None:
    """As Illustrator writes a drawing of 100 mm."""
    units, far = square('width="100mm" viewBox="0 0 283.46 141.73"')
    assert (units, far) == ("mm", (10 * (100 / 283.46), 10 * (100 / 283.46)))


@pytest.mark.parametrize(
    "head",
    [
        f'width="100" height="50" {BOX}',
        f'width="100px" height="10px" {BOX}',
        f'width="100%" height="50mm" {BOX}',
        f'width="100mm" height="100%" {BOX}',
        f'width="10em" {BOX}',
        f'width="200mm" height="100mm" style="width: 50mm" {BOX}',
        'width="200mm" height="100mm"',
        f'{BOX} preserveAspectRatio="none"',
    ],
)
def test_other_sizes_leave_user_units(head: str) -> None:
    assert square(head) == (None, (10, 10))


def test_pixels_stretch_too() -> None:
    assert square(f'width="200" height="50" {BOX} preserveAspectRatio="none"') == (None, (10, 5))


@pytest.mark.parametrize(
    ("head", "code"),
    [
        (f'width="100%" height="50mm" {BOX} preserveAspectRatio="none"', "unsupported-feature"),
        (f'width="0mm" height="50mm" {BOX}', "bad-record"),
        (f'width="10mm" height="-5mm" {BOX}', "bad-record"),
        (f'width="10mm" {BOX} preserveAspectRatio="middle"', "bad-record"),
    ],
)
def test_a_size_that_is_not_known_is_refused(head: str, code: str) -> None:
    with pytest.raises(MeshFileError) as refused:
        square(head)
    assert refused.value.code == code


def test_a_view_within_a_view() -> None:
    """Both scales: half a millimetre a unit, of which the inner one makes two."""
    text = (
        f'<svg xmlns="http://www.w3.org/2000/svg" width="200mm" height="50mm" {BOX}>'
        '<svg x="20" y="10" width="40" height="60" viewBox="0 0 20 20" '
        'preserveAspectRatio="xMinYMin"><rect width="10" height="10"/></svg></svg>'
    )
    drawing = read_svg(text.encode())
    (shape,) = drawing.shapes
    assert isinstance(shape, DrawnShape)
    points = shape.contours[0].points
    assert (min(points), max(points)) == ((10, 5), (20, 15))


def test_curves_are_scaled_with_their_deviation() -> None:
    circle = '<circle r="100"/></svg>'
    head = f'<svg xmlns="http://www.w3.org/2000/svg" {BOX}'
    plain, small = (
        read_svg(f"{head} {size}>{circle}".encode()) for size in ("", 'width="20mm" height="10mm"')
    )
    (one,), (other,) = plain.shapes, small.shapes
    assert isinstance(one, DrawnShape)
    assert isinstance(other, DrawnShape)
    assert other.contours[0].deviation == pytest.approx(one.contours[0].deviation / 10)
