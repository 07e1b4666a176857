"""The same bits on every system: the solver calls no function of the C library that systems round
differently. `core/native/tests/ladder/test_same_bits.cpp` pins a hash of 10,000 results."""

import re
from pathlib import Path

NATIVE = Path(__file__).parents[2] / "core" / "native"
# IEEE 754 prescribes the result of sqrt, fma and of what only moves bits. These it leaves open.
OPEN = "hypot|a?(?:sin|cos|tan)h?|atan2|exp2?|expm1|log(?:2|10|1p)?|pow|cbrt"
CALL = re.compile(rf"\b(?:std::)?({OPEN})\s*\(")


def test_no_call_is_rounded_as_the_system_likes() -> None:
    sources = [path for path in NATIVE.rglob("*.[ch]pp") if "tests" not in path.parts]
    assert len(sources) > 200
    calls = {
        str(path.relative_to(NATIVE)): found
        for path in sources
        if (found := CALL.findall(re.sub(r"//.*|\"[^\"]*\"", "", path.read_text())))
    }
    assert calls == {}
