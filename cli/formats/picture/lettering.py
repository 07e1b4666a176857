"""Letters in an image, of strokes with round ends. Letters with accents lose them, and other
writing becomes boxes: the page shows all of it."""

from __future__ import annotations

import unicodedata
from functools import cache
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    import numpy.typing as npt

    Floats = npt.NDArray[np.float64]
    Image = npt.NDArray[np.uint8]
    Colour = tuple[float, float, float]

# Strokes, on a grid 4 wide and 6 high above the line; `-` continues below it. A stroke is a row of
# points: across and up, a digit each, with `a` and `b` for 1 and 2 below the line.
_STROKES = {
    "A": "002640 1232",
    "B": "00063645443303 3342413000",
    "C": "4536160501103041",
    "D": "00063645413000",
    "E": "46060040 0333",
    "F": "460600 0333",
    "G": "45361605011030414323",
    "H": "0006 4046 0343",
    "I": "1636 2620 1030",
    "J": "4641301001",
    "K": "0006 4603 1440",
    "L": "060040",
    "M": "0006234640",
    "N": "00064046",
    "O": "103041453616050110",
    "P": "00063645443303",
    "Q": "103041453616050110 2240",
    "R": "00063645443303 2340",
    "S": "453616050413334241301001",
    "T": "0646 2620",
    "U": "060110304146",
    "V": "062046",
    "W": "0610233046",
    "X": "0046 0640",
    "Y": "062346 2320",
    "Z": "06460040",
    "a": "1434433010010212 0212 1242 4340",
    "b": "0600 0313344341301001",
    "c": "43341403011030 3041",
    "d": "4640 4334140301103041",
    "e": "02424334140301103041",
    "f": "36261510 0434",
    "g": "4334140301103041 444b3b1b0a",
    "h": "0600 03143443 4340",
    "i": "142420 1030 2626",
    "j": "242a1b0b 2626",
    "k": "0600 4401 1240",
    "l": "1626 2620 1030",
    "m": "0400 031423 2320 23344340",
    "n": "0400 03143443 4340",
    "o": "1434434130100103 0314",
    "p": "040b 0314344341301001",
    "q": "444b 4334140301103041",
    "r": "0400 02143443",
    "s": "433414031232413010 1001",
    "t": "26213041 0434",
    "u": "0401103041 4440",
    "v": "042044",
    "w": "0410223044",
    "x": "0044 0440",
    "y": "0420 441b0b",
    "z": "04440040",
    "0": "103041453616050110 1135",
    "1": "1526 2620 1030",
    "2": "051636454400 0040",
    "3": "0516364544332342413010 1001 2333",
    "4": "30360242",
    "5": "460603334241301001",
    "6": "45361605011030414233 3302",
    "7": "064610",
    "8": "130405163645443313 1302011030414233",
    "9": "0110304145361605041343",
    ".": "2020",
    ",": "211a",
    ":": "2020 2424",
    ";": "211a 2424",
    "!": "2622 2020",
    "?": "051636454423 2322 2020",
    "-": "0343",
    "+": "0343 2125",
    "=": "0242 0444",
    "_": "0a4a",
    "/": "0046",
    "\\": "0640",
    "|": "262a",
    "(": "36252130 3021",
    ")": "16252110",
    "[": "36161030",
    "]": "16363010",
    "{": "3626251322212030",
    "}": "1626253322212010",
    "<": "440341",
    ">": "044301",
    "*": "1135 1531 0343",
    "#": "1016 3036 0242 0444",
    "%": "0046 0506 4041",
    "&": "4014051626351201102042",
    "@": "3323223233 32424536160501103041",
    "'": "2624",
    '"': "1614 3634",
    "`": "1625",
    "^": "042644",
    "~": "03143344",
    "$": "453616050413334241301001 2620",
    "°": "1626251516",
    "±": "0444 2226 0141",
    "…": "0000 2020 4040",
}
_BOX = "0006464000"
_UNITS = {"a": -1, "b": -2}
_ADVANCE, _HEIGHT = 5.6, 6.0  # of a letter on the grid
_STROKE = 0.11  # width, of the height


def width_of(text: str, height: float) -> float:
    """In pixels. height: of a capital letter."""
    return len(plain(text)) * _ADVANCE * height / _HEIGHT


def plain(text: str) -> str:
    """Without accents."""
    parts = unicodedata.normalize("NFKD", text) if not text.isascii() else text
    return "".join(c for c in parts if not unicodedata.combining(c)) if parts is not text else text


def write(image: Image, text: str, left: float, base: float, height: float, colour: Colour) -> None:
    """Draws over an image, (rows, columns, 3). left, base: where the line begins, in pixels.
    height: of a capital letter. What is beyond the image is left out."""
    scale = height / _HEIGHT
    ink = np.array(colour) * 255.0
    for number, letter in enumerate(plain(text)):
        pieces = _pieces(letter)
        if not len(pieces):
            continue
        ends = pieces * [scale, -scale] + [left + number * _ADVANCE * scale, base]
        low = np.maximum(np.floor(ends.min(axis=(0, 1)) - height), 0).astype(int)
        high = np.minimum(np.ceil(ends.max(axis=(0, 1)) + height), image.shape[1::-1]).astype(int)
        if (high <= low).any():
            continue
        area = image[low[1] : high[1], low[0] : high[0]]
        x, y = np.meshgrid(np.arange(low[0], high[0]) + 0.5, np.arange(low[1], high[1]) + 0.5)
        off = _distance(np.stack([x, y], axis=-1), ends)
        share = np.clip(max(_STROKE * height, 1.2) / 2 + 0.5 - off, 0.0, 1.0)[..., None]
        area[:] = (area * (1.0 - share) + ink * share + 0.5).astype(np.uint8)


@cache
def _pieces(letter: str) -> Floats:
    """Its strokes as pieces from a point to a point, (n, 2, 2), on the grid."""
    strokes = "" if letter.isspace() else _STROKES.get(letter, _BOX)
    pieces = []
    for stroke in strokes.split():
        numbers = [_UNITS[c] if c in _UNITS else int(c) for c in stroke]
        points = list(zip(numbers[::2], numbers[1::2], strict=False))
        pieces += list(zip(points, points[1:] or points, strict=False))
    return np.array(pieces, dtype=float).reshape(-1, 2, 2)


def _distance(points: Floats, pieces: Floats) -> Floats:
    """From each point to the nearest piece."""
    start, along = pieces[:, 0], pieces[:, 1] - pieces[:, 0]
    to = points[..., None, :] - start
    length = (along**2).sum(axis=1)
    share = np.clip((to * along).sum(axis=-1) / np.where(length > 0.0, length, 1.0), 0.0, 1.0)
    off: Floats = np.linalg.norm(to - share[..., None] * along, axis=-1).min(axis=-1)
    return off
