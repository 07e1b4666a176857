"""Attributes, style and style sheets: which wins, and what is not understood is refused."""

from __future__ import annotations

import pytest

from satcheck.scene.drawing.contour import DrawnShape, RefusedShape
from satcheck.scene.drawing.svg import read_svg
from satcheck.scene.errors import MeshFileError

D = 'd="M0 0H4V4H0Z"'


def shapes(style: str, body: str) -> tuple[DrawnShape | RefusedShape, ...]:
    return read_svg(f"<svg><style>{style}</style>{body}</svg>".encode()).shapes


@pytest.mark.parametrize(
    ("style", "body"),
    [
        ("", f'<path {D} fill-rule="evenodd"/>'),
        ("", f'<path {D} style="fill-rule : evenodd"/>'),
        ("", f'<path {D} fill-rule="nonzero" style="fill-rule:evenodd"/>'),
        ("", f'<g style="fill-rule:evenodd"><path {D} style="fill-rule:inherit"/></g>'),
        ("path{fill-rule:evenodd}", f'<path {D} fill-rule="nonzero"/>'),
        ("path{fill-rule:evenodd!important}", f'<path {D} style="fill-rule:nonzero"/>'),
        ("*{fill-rule:nonzero} .a,.b{fill-rule:evenodd}", f'<path {D} class="c b"/>'),
        (".b{fill-rule:evenodd} path{fill-rule:nonzero}", f'<path {D} class="b"/>'),
        ("#i{fill-rule:evenodd} .b.c{fill-rule:nonzero}", f'<path {D} id="i" class="b c"/>'),
        ("path{fill-rule:nonzero} path{fill-rule:evenodd}", f"<path {D}/>"),
        ("g path{fill-rule:evenodd}", f"<g><a><path {D}/></a></g>"),
        ("g > path{fill-rule:nonzero} a>path{fill-rule:evenodd}", f"<g><a><path {D}/></a></g>"),
        ("[a='1']{fill-rule:evenodd}", f'<path {D} a="1"/>'),
        ("path:hover{fill-rule:nonzero}", f'<path {D} fill-rule="evenodd"/>'),
        ("@media print{path{fill-rule:nonzero}}", f'<path {D} fill-rule="evenodd"/>'),
        ("path:first-child{stroke:red}", f'<path {D} fill-rule="evenodd"/>'),
        ("@font-face{src:url(data:a;b{};c)}", f'<path {D} fill-rule="evenodd"/>'),
        ("path:not(.a){fill-rule:evenodd}", f"<path {D}/>"),
        ("title + path{fill-rule:evenodd", f"<title/><path {D}/>"),
        ("/* path{fill-rule:nonzero} */", f'<path {D} fill-rule="evenodd"/>'),
    ],
)
def test_the_cascade(style: str, body: str) -> None:
    (shape,) = shapes(style, body)
    assert isinstance(shape, DrawnShape)
    assert shape.rule == "evenodd"


@pytest.mark.parametrize(
    ("style", "body", "shown"),
    [
        ("", f'<g display="none"><path {D} display="inline"/></g>', False),
        ("", f'<g visibility="hidden"><path {D} visibility="visible"/></g>', True),
        ("", f'<g visibility="hidden"><path {D}/></g>', False),
        ("g.n > path{display:none}", f'<g class="n"><path {D}/></g>', False),
        ("g.n > path{display:none}", f'<g class="n"><g><path {D}/></g></g>', True),
        ("", f'<path {D} style="display:none;display:inline"/>', True),
        ("svg{display:none}", f"<path {D}/>", False),
    ],
)
def test_what_is_shown(style: str, body: str, shown: bool) -> None:
    assert len(shapes(style, body)) == shown


@pytest.mark.parametrize(
    "style",
    [
        "path:unheard-of{display:none}",
        "} path{display:none}",
        "@import 'other.css';",
        "@media (min-width:9px){path{fill-rule:evenodd}}",
        "path{fill:var(--a)}",
    ],
)
def test_a_sheet_that_is_not_understood_is_refused(style: str) -> None:
    with pytest.raises(MeshFileError) as caught:
        shapes(style, f"<path {D}/>")
    assert caught.value.code == "unsupported-feature"


@pytest.mark.parametrize(
    "declared",
    ["transform:scale(2)", "x:5px", "d:path('M0 0')", "rotate:9deg", "all:unset", "display:foo"],
)
def test_a_style_that_could_move_or_shape_is_refused(declared: str) -> None:
    for style, attribute in ((f"path{{{declared}}}", ""), ("", f' style="{declared}"')):
        (shape,) = shapes(style, f"<path {D}{attribute}/>")
        assert isinstance(shape, RefusedShape)
        assert shape.code == "unsupported-feature"
