"""SVG: shapes, transforms, fill rules; what is left out is said, what is broken is refused."""

from __future__ import annotations

import math
from itertools import pairwise

import pytest

from satcheck.scene.drawing.contour import FLATNESS, Drawing, DrawnShape, RefusedShape
from satcheck.scene.drawing.svg import read_svg
from satcheck.scene.errors import MeshFileError

HEAD = '<svg xmlns="http://www.w3.org/2000/svg" xmlns:x="http://www.w3.org/1999/xlink" '
MM = 'width="210mm" height="297mm" viewBox="0 0 210 297">'


def read(body: str, head: str = MM) -> Drawing:
    return read_svg(f"{HEAD}{head}{body}</svg>".encode())


def drawn(body: str, head: str = MM) -> list[DrawnShape]:
    shapes = [shape for shape in read(body, head).shapes if isinstance(shape, DrawnShape)]
    assert len(shapes) == len(read(body, head).shapes)
    return shapes


def only(body: str, head: str = MM) -> DrawnShape:
    (shape,) = drawn(body, head)
    return shape


def extents(shape: DrawnShape) -> tuple[float, ...]:
    """min x, min y, max x, max y."""
    xs, ys = zip(*(p for contour in shape.contours for p in contour.points), strict=True)
    return min(xs), min(ys), max(xs), max(ys)


def test_millimetres_are_not_turned_into_pixels() -> None:
    drawing = read('<rect id="r" x="10.1" y="20.2" width="5" height="4"/>')
    (shape,) = drawing.shapes
    assert isinstance(shape, DrawnShape)
    assert (drawing.units, shape.name) == ("mm", "r")
    assert shape.contours[0].points[0] == (10.1, 20.2)


@pytest.mark.parametrize(
    "head", [">", 'width="100" height="50">', 'width="210mm">', 'viewBox="0 0 210 297">']
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
    shape = only('<defs><rect id="r" width="5" height="5"/></defs><use x:href="#r" x="100"/>')
    assert shape.contours[0].points[0] == (100.0, 0.0)


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
    ("element", "code"),
    [
        ('<path d="M 0 0 L nan 3 z"/>', "bad-record"),
        ('<path d="M 0 0 L 5"/>', "bad-record"),
        ('<path d="M 0 0 L 55"/>', "bad-record"),
        ('<path d="M 0 0 X 5 5"/>', "bad-record"),
        ('<path d="L 5 5 0 5 z"/>', "bad-record"),
        ('<path d="M 0 0 A 1 1 0 2 0 5 5"/>', "bad-record"),
        ('<path d="M 0 0 L 1e999 0 L 0 1 z"/>', "non-finite"),
        ('<circle r="-1"/>', "bad-record"),
        ('<rect width="1e10" height="1" transform="scale(1e300)"/>', "non-finite"),
        ('<ellipse rx="1"/>', "unsupported-feature"),
        ('<polygon points="0 0 1 0 1"/>', "bad-record"),
        ('<rect width="1em" height="1"/>', "unsupported-feature"),
        ('<rect width="1" height="1" transform="rotate(90deg)"/>', "bad-record"),
        ('<use href="#nothing"/>', "index-out-of-range"),
        ('<g transform="rotate(9)" transform-origin="5 5"/>', "unsupported-feature"),
        ('<rect width="1" height="1" style="translate:10px"/>', "unsupported-feature"),
        ('<g><rect width="9" height="1"/><animateTransform/></g>', "unsupported-feature"),
        ('<g systemLanguage="de"><rect width="9" height="1"/></g>', "unsupported-feature"),
    ],
)
def test_an_element_that_is_not_read_is_a_refused_shape(element: str, code: str) -> None:
    refused, beside = read(f'{element}<rect id="r" width="1" height="1"/>').shapes
    assert isinstance(refused, RefusedShape)
    assert refused.code == code
    assert refused.message.startswith(f"{element.split()[0].split('>')[0]}")
    assert beside.name == "r"


def test_compact_arc_flags_are_read() -> None:
    (contour,) = only('<path d="M0,0a5 5 0 0110 0z"/>').contours
    assert max(x for x, _ in contour.points) == pytest.approx(10.0, abs=1e-9)


@pytest.mark.parametrize(
    ("text", "code"),
    [
        ("<svg>\n<rect></svg>", "bad-record"),
        ("<!DOCTYPE a [<!ENTITY a 'b'>]><svg>&a;</svg>", "entity-declaration"),
        ("<html/>", "not-this-format"),
        ("<?xml-stylesheet href='a.css'?><svg/>", "unsupported-feature"),
        ('<svg transform="scale(2)"/>', "unsupported-feature"),
        ('<svg viewBox="0 0 1"/>', "bad-record"),
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
    shape = only('<symbol id="s"><rect width="9" height="9"/></symbol><use href="#s" x="3"/>')
    assert min(x for x, _ in shape.contours[0].points) == 3


@pytest.mark.parametrize("how", ['clip-path="url(#c)"', 'style="fill:red; mask: url(#c)"'])
def test_what_cuts_a_shape_is_ignored_with_a_warning(how: str) -> None:
    drawing = read(f'<rect {how} width="2" height="2"/>')
    (warning,) = drawing.ignored
    assert warning == "clip paths and masks are ignored: shapes are taken whole"
    assert len(drawing.shapes) == 1


@pytest.mark.parametrize("head", ['width="200" height="100">', 'viewBox="5 5 200 100">'])
def test_percentages_are_of_the_drawing(head: str) -> None:
    """The radius is of the root mean square of the sides."""
    drawing = '<rect x="50%" y="10%" width="10%" height="100%"/><circle r="10%"/>'
    rectangle, circle = drawn(drawing, head)
    assert extents(rectangle) == (100.0, 10.0, 120.0, 110.0)
    assert extents(circle)[2] == pytest.approx(math.sqrt((200**2 + 100**2) / 2) / 10)
    (refused,) = read('<rect width="10%" height="1"/>', ">").shapes
    assert isinstance(refused, RefusedShape)
    assert "percentage" in refused.message


@pytest.mark.parametrize(
    ("aspect", "expected"),
    [
        ("", (20.0, 20.0, 40.0, 30.0)),
        ('preserveAspectRatio="xMinYMin"', (20.0, 15.0, 40.0, 25.0)),
        ('preserveAspectRatio="xMaxYMax slice"', (0.0, 15.0, 40.0, 35.0)),
        ('preserveAspectRatio="none"', (20.0, 15.0, 40.0, 35.0)),
    ],
)
def test_viewports_within(aspect: str, expected: tuple[float, ...]) -> None:
    """A box of 20 x 10 from (-10, -5), shown at (20, 15) in 20 x 20: by an inner <svg>, and by a
    symbol that is used."""
    box = f'viewBox="-10 -5 20 10" {aspect}'
    place = 'x="20" y="15" width="20" height="20"'
    within = '<rect x="-50%" y="-50%" width="100%" height="100%"/>'
    assert extents(only(f"<svg {place} {box}>{within}</svg>")) == expected
    symbol = f'<symbol id="s" {box}>{within}</symbol>'
    assert extents(only(f'{symbol}<use href="#s" {place}/>')) == expected


def test_a_symbol_without_a_size_fills_the_viewport() -> None:
    symbol = '<symbol id="s" viewBox="0 0 1 1"><rect width="1" height="1"/></symbol>'
    assert extents(only(f'{symbol}<use href="#s"/>', 'viewBox="0 0 8 8">')) == (0, 0, 8, 8)


def test_quarter_turns_are_exact() -> None:
    shape = only('<rect x="1" width="2" height="1" transform="rotate(90 5 5) rotate(-180)"/>')
    assert shape.contours[0].points == ((10.0, -1.0), (10.0, -3.0), (11.0, -3.0), (11.0, -1.0))


def test_lengths_have_units() -> None:
    assert extents(only('<rect width="1in" height="72pt"/>')) == (0.0, 0.0, 96.0, 96.0)
    assert extents(only('<rect x="1cm" width="6pc" height="1"/>'))[0] == pytest.approx(96 / 2.54)


def test_smooth_curves_reflect_the_control_before() -> None:
    smooth = only('<path d="M0 0 C 0 1 1 1 1 0 S 2 -1 2 0 Q 3 1 4 0 T 6 0 L 9 9 z"/>')
    plain = only('<path d="M0 0 C 0 1 1 1 1 0 C 1 -1 2 -1 2 0 Q 3 1 4 0 Q 5 -1 6 0 L 9 9 z"/>')
    assert smooth.contours == plain.contours


def test_relative_commands() -> None:
    found = only('<path d="m1 1 2 0 0 2zl-1 0v-1h1z m3 0h1v1"/>').contours
    assert [contour.points for contour in found] == [
        ((1.0, 1.0), (3.0, 1.0), (3.0, 3.0)),
        ((1.0, 1.0), (0.0, 1.0), (0.0, 0.0), (1.0, 0.0)),
        ((4.0, 1.0), (5.0, 1.0), (5.0, 2.0)),
    ]


@pytest.mark.parametrize("flags", ["00", "01", "10", "11"])
def test_the_four_arcs_between_two_points(flags: str) -> None:
    """From (0, 0) to (2, 0) at a radius of 2: about (1, -+sqrt 3), and which way round."""
    (contour,) = only(f'<path d="M0 0A2 2 0 {flags} 2 0L1 0z"/>').contours
    large, sweep = flags
    ys = [y for _, y in contour.points]
    low = 2 - math.sqrt(3) if large == "0" else 2 + math.sqrt(3)
    reach = min(ys) if sweep == "1" else -max(ys)
    assert reach == pytest.approx(-low, abs=1e-3)


@pytest.mark.parametrize(
    ("corners", "size"), [('rx="1"', 1.0), ('rx="9" ry="1"', 2.0), ('ry="1"', 1.0)]
)
def test_rounded_corners(corners: str, size: float) -> None:
    """size: the first x at the top, after the radius was cut to half of a side."""
    shape = only(f'<rect width="4" height="3" {corners}/>')
    assert extents(shape) == (0.0, 0.0, 4.0, 3.0)
    assert min(x for x, y in shape.contours[0].points if y == 0) == size


def test_what_is_no_drawing_is_not_read() -> None:
    inner = '<rect width="9" height="9"/>'
    assert read(f"<foreignObject>{inner}</foreignObject>").shapes == ()
    assert read(f'<a xmlns="other">{inner}</a>').shapes == ()


def test_a_switch_draws_the_first_that_is_for_all() -> None:
    extension = '<foreignObject requiredExtensions="x"/>'
    first, second = (f'<rect id="{id_}" width="1" height="1"/>' for id_ in "ab")
    assert only(f"<switch>{extension}{first}{second}</switch>").name == "a"


def test_references_that_explode_are_counted_and_refused() -> None:
    levels = "".join(
        f'<g id="g{n}"><use href="#g{n - 1}"/><use href="#g{n - 1}"/></g>' for n in range(1, 40)
    )
    bomb = f'<defs><g id="g0"/>{levels}</defs><use href="#g39"/>'
    circle = '<g id="a"><g><use href="#a"/></g></g>'
    deep = "<g>" * 20000 + "</g>" * 20000
    for body, code in ((bomb, "too-large"), (circle, "reference-cycle"), (deep, "too-large")):
        with pytest.raises(MeshFileError) as caught:
            read(body)
        assert caught.value.code == code
