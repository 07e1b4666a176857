"""SVG: shapes, transforms, fill rules; what is left out is said, what is broken is refused."""

from __future__ import annotations

import math
from itertools import pairwise

import pytest

from satcheck.scene.drawing.contour import FLATNESS, Drawing, DrawnShape
from satcheck.scene.drawing.svg import read_svg
from satcheck.scene.errors import MeshFileError

HEAD = '<svg xmlns="http://www.w3.org/2000/svg" xmlns:x="http://www.w3.org/1999/xlink" '
MM = 'width="210mm" height="297mm" viewBox="0 0 210 297">'


def read(body: str, head: str = MM) -> Drawing:
    return read_svg(f"{HEAD}{head}{body}</svg>".encode())


def only(body: str) -> DrawnShape:
    (shape,) = read(body).shapes
    return shape


def test_millimetres_are_not_turned_into_pixels() -> None:
    drawing = read('<rect id="r" x="10.1" y="20.2" width="5" height="4"/>')
    (shape,) = drawing.shapes
    assert (drawing.units, shape.name) == ("mm", "r")
    assert shape.contours[0].points[0] == (10.1, 20.2)


@pytest.mark.parametrize(
    "head", [">", 'width="100" height="50">', 'width="210mm" viewBox="0 0 1 1">']
)
def test_no_unit_where_the_file_gives_none(head: str) -> None:
    assert read('<rect width="5" height="4"/>', head).units is None


def test_transforms_add_up() -> None:
    shape = only(
        '<g transform="translate(10,20)"><rect width="2" height="1" transform="rotate(90)"/></g>'
    )
    expected = [(10, 20), (10, 22), (9, 22), (9, 20)]
    for found, corner in zip(shape.contours[0].points, expected, strict=True):
        assert found == pytest.approx(corner, abs=1e-14)


def test_reuse() -> None:
    drawing = read('<defs><rect id="r" width="5" height="5"/></defs><use x:href="#r" x="100"/>')
    assert drawing.shapes[0].contours[0].points[0] == (100.0, 0.0)


def test_holes_keep_their_fill_rule() -> None:
    d = "M0,0 h10 v10 h-10 z M2,2 v6 h6 v-6 z"
    assert only(f'<path d="{d}" fill-rule="evenodd"/>').rule == "evenodd"
    assert only(f'<path d="{d}"/>').rule == "nonzero"
    assert len(only(f'<path d="{d}"/>').contours) == 2


def test_a_circle_is_flattened_within_what_is_said() -> None:
    (contour,) = only('<circle cx="3" cy="4" r="5"/>').contours
    assert 0 < contour.deviation < 5 * 2 * FLATNESS
    for (ax, ay), (bx, by) in pairwise(contour.points):
        for k in range(5):
            x, y = ax + (bx - ax) * k / 4, ay + (by - ay) * k / 4
            assert abs(math.hypot(x - 3, y - 4) - 5) <= contour.deviation


def test_a_skewed_arc_lies_on_its_ellipse() -> None:
    """x^2 / 225 + y^2 / 4 = 1 in the frame that is turned by 30 degrees, off by the rounding of the
    library's centre, which the deviation contains."""
    (contour,) = only('<ellipse rx="5" ry="2" transform="rotate(30) scale(3 1)"/>').contours
    c, s = math.cos(math.radians(30)), math.sin(math.radians(30))
    for x, y in contour.points:
        u, v = c * x + s * y, -s * x + c * y
        assert math.hypot(u / 15, v / 2) == pytest.approx(1.0, abs=contour.deviation)


@pytest.mark.parametrize("controls", ["Q 5 10 10 0", "C 0 10 10 10 10 0", "C 10 10 0 10 10 0"])
def test_beziers(controls: str) -> None:
    """Points of the curve, densely, against the polygon."""
    (contour,) = only(f'<path d="M 0 0 {controls} Z"/>').contours
    numbers = [float(word) for word in controls[2:].split()]
    hull = [(0.0, 0.0), *zip(numbers[::2], numbers[1::2], strict=True)]

    def at(t: float) -> tuple[float, float]:
        n = len(hull) - 1
        weights = [math.comb(n, k) * t**k * (1 - t) ** (n - k) for k in range(n + 1)]
        return tuple(  # type: ignore[return-value]
            math.fsum(w * p[axis] for w, p in zip(weights, hull, strict=True)) for axis in (0, 1)
        )

    edges = list(zip(contour.points, contour.points[1:], strict=False))
    rounding = 1e-13
    for k in range(201):
        p = at(k / 200)
        assert min(_to_segment(p, a, b) for a, b in edges) <= contour.deviation + rounding


def _to_segment(p: tuple[float, float], a: tuple[float, float], b: tuple[float, float]) -> float:
    d = (b[0] - a[0], b[1] - a[1])
    t = ((p[0] - a[0]) * d[0] + (p[1] - a[1]) * d[1]) / (d[0] ** 2 + d[1] ** 2)
    t = min(1.0, max(0.0, t))
    return math.dist(p, (a[0] + t * d[0], a[1] + t * d[1]))


def test_what_is_left_out_is_said() -> None:
    drawing = read(
        '<rect width="1" height="1"/><text>T</text><rect width="1" height="1" display="none"/>'
        '<path d="M0 0 L 5 5" fill="none" stroke="red"/>'
    )
    assert len(drawing.shapes) == 1
    assert drawing.ignored == ("open lines are ignored", "text elements are ignored")


def test_a_closed_line_without_fill_is_an_outline() -> None:
    assert len(read('<path d="M0 0 h5 v5 z" fill="none" stroke="red"/>').shapes) == 1


@pytest.mark.parametrize(
    ("d", "code"),
    [
        ("M 0 0 L nan 3 z", "bad-record"),
        ("M 0 0 L 5", "bad-record"),
        ("M 0 0 X 5 5", "bad-record"),
        ("M 0 0 A 1 1 0 2 0 5 5", "bad-record"),
        ("M 0 0 L 1e999 0 L 0 1 z", "non-finite"),
    ],
)
def test_broken_path_data_is_refused(d: str, code: str) -> None:
    with pytest.raises(MeshFileError) as caught:
        read(f'<path d="{d}"/>')
    assert caught.value.code == code


def test_compact_arc_flags_are_read() -> None:
    (contour,) = only('<path d="M0,0a5 5 0 0110 0z"/>').contours
    assert max(x for x, _ in contour.points) == pytest.approx(10.0, abs=1e-9)


@pytest.mark.parametrize(
    ("text", "code"),
    [
        ("<svg>\n<rect></svg>", "bad-record"),
        ("<!DOCTYPE a [<!ENTITY a 'b'>]><svg>&a;</svg>", "entity-declaration"),
        ("<html/>", "not-this-format"),
    ],
)
def test_broken_files_are_refused(text: str, code: str) -> None:
    with pytest.raises(MeshFileError) as caught:
        read_svg(text.encode())
    assert caught.value.code == code


@pytest.mark.parametrize("template", ["symbol", "marker", "pattern", "mask", "clipPath"])
def test_a_template_is_drawn_only_where_it_is_used(template: str) -> None:
    unused = f'<{template}><rect width="9" height="9"/></{template}>'
    drawing = read(f'{unused}<rect id="r" width="1" height="1"/>')
    assert [shape.name for shape in drawing.shapes] == ["r"]
    used = read('<symbol id="s"><rect width="9" height="9"/></symbol><use href="#s" x="3"/>')
    (shape,) = used.shapes
    assert min(x for x, _ in shape.contours[0].points) == 3


@pytest.mark.parametrize("how", ['clip-path="url(#c)"', 'style="fill:red; mask: url(#c)"'])
def test_what_cuts_a_shape_is_ignored_with_a_warning(how: str) -> None:
    drawing = read(f'<rect {how} width="2" height="2"/>')
    (warning,) = drawing.ignored
    assert warning.endswith("is ignored: shapes are taken whole")
    assert len(drawing.shapes) == 1
