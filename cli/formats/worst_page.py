"""The worst findings of many scenes as one HTML page with their pictures. It needs no network and
runs no script."""

from __future__ import annotations

from base64 import b64encode
from collections.abc import Iterable, Iterator
from html import escape
from typing import TYPE_CHECKING

from satcheck.audit.words import counted
from satcheck.cli.formats.assets import cells_of, summary_line
from satcheck.cli.output import harmless, issue_line
from satcheck.report.verdict import severity

if TYPE_CHECKING:
    from satcheck.cli.formats.assets import Overview
    from satcheck.report.assets import Asset
    from satcheck.report.report import Finding

_BEGIN = """<!doctype html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<meta http-equiv="Content-Security-Policy"
 content="default-src 'none'; img-src data:; style-src 'unsafe-inline'">
<title>satcheck: the worst findings</title>
<style>
:root { color-scheme: light dark; --line: #8884; --soft: #888; }
body { font: 14px/1.45 system-ui, sans-serif; margin: 1.5rem auto; max-width: 84rem;
 padding: 0 1rem; }
h1 { font-size: 1.1rem; overflow-wrap: anywhere; }
h2 { font-size: 1rem; margin: 2rem 0 .6rem; }
ol { list-style: none; padding: 0; display: grid; gap: 1rem;
 grid-template-columns: repeat(auto-fill, minmax(20rem, 1fr)); }
li { border: 1px solid var(--line); border-top: 4px solid #4080bf; border-radius: 4px;
 padding: .6rem; overflow-wrap: anywhere; }
li.error { border-top-color: #d33; }
li.warning { border-top-color: #c80; }
img, .none { display: block; width: 100%; aspect-ratio: 4 / 3; background: #fff; }
.none { display: grid; place-items: center; background: #8882; text-align: center; padding: 1rem;
 box-sizing: border-box; }
p { margin: .4rem 0 0; }
small, .none { color: var(--soft); }
table { border-collapse: collapse; width: 100%; }
td, th { text-align: left; padding: .25rem .6rem .25rem 0; border-bottom: 1px solid var(--line);
 vertical-align: top; overflow-wrap: anywhere; }
th { white-space: nowrap; }
td:first-child { min-width: 12rem; }
</style>
</head>
<body>
"""
_END = "</body>\n</html>\n"


def render(seen: Overview, worst: Iterable[tuple[Asset, Finding, bytes | str]]) -> Iterator[str]:
    """worst: the scene, the finding, and its picture (PNG) or why there is none. Each is taken when
    it is written."""
    yield _BEGIN
    yield f"<h1>{_text(summary_line(seen))}</h1>\n"
    if seen.issues:
        yield "".join(f"<p>{_text(issue_line(issue))}</p>\n" for issue in seen.issues)
    yield "<h2>The worst findings</h2>\n<ol>\n"
    number = 0
    for number, (asset, finding, picture) in enumerate(worst, 1):
        yield _item(number, asset, finding, picture)
    yield "</ol>\n" if number else "</ol>\n<p>There is none.</p>\n"
    yield from _scenes(seen)
    yield _END


def _item(number: int, asset: Asset, finding: Finding, picture: bytes | str) -> str:
    told = _text(finding.message)
    return (
        f'<li class="{severity(finding)}">{_picture(picture)}'
        f"<p>{number}. <b>{_text(asset.file)}</b></p><p>{told}</p></li>\n"
    )


def _picture(picture: bytes | str) -> str:
    if isinstance(picture, str):
        return f'<div class="none">No picture: {_text(picture)}</div>'
    return f'<img alt="" src="data:image/png;base64,{b64encode(picture).decode()}">'


def _scenes(seen: Overview) -> Iterator[str]:
    if not seen.shown:
        return
    yield "<h2>The worst scenes</h2>\n<table>\n"
    yield "<tr><th>scene</th><th>verdict</th><th>failing pairs</th><th>worst</th></tr>\n"
    for asset in seen.shown:
        cells = cells_of(asset)
        yield f"<tr>{''.join(f'<td>{_text(cell)}</td>' for cell in cells)}</tr>\n"
    yield "</table>\n"
    if hidden := seen.listed - len(seen.shown):
        yield f"<p>{counted(hidden, 'more scene')} not shown.</p>\n"


def _text(text: str) -> str:
    """Names from files are text, never markup, and do not reorder what stands beside them."""
    return escape(harmless(text))
