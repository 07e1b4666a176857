"""An SVG of ours as a PNG, the same on every machine: drawn by resvg with a font of the extra."""

from __future__ import annotations

from importlib.util import find_spec

EXTRA = "png"
_MODULES = ("resvg_py", "fontpkg", "fontpkg_noto_sans")
_FONT = "Noto Sans"
_PIXELS_PER_UNIT = 2.0


def is_available() -> bool:
    """Whether the libraries of the extra are installed."""
    return all(find_spec(name) is not None for name in _MODULES)


def png(drawing: str) -> bytes:
    """On light paper. Raises ModuleNotFoundError where the extra is not installed."""
    from fontpkg import path
    from resvg_py import svg_to_bytes

    drawn: bytes = svg_to_bytes(
        svg_string=drawing,
        zoom=_PIXELS_PER_UNIT,
        skip_system_fonts=True,
        font_files=[str(path(_FONT))],
        font_family=_FONT,
        sans_serif_family=_FONT,
    )
    return drawn
