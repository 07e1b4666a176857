"""What a release holds beside `python -m tests`: `python -m tests.release [A B]...`.

clang    The C++ tests build and pass with a second compiler.
aarch64  The C++ tests pass on another kind of machine, which qemu emulates.
dumps    What the core computes of pairs of mesh files is the same there, byte for byte.

Needs clang++, aarch64-linux-gnu-g++ and qemu-aarch64 (on Debian the packages clang,
g++-aarch64-linux-gnu and qemu-user). A and B are further mesh files (obj, stl, ply, off).
Exit code 0 when every step passed, else 1.
"""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
from collections.abc import Sequence
from pathlib import Path

from tests.__main__ import BUILD, FAILED, PASSED, ROOT, Outcome, native_tests, run, say

CLANG, AARCH64, HERE = BUILD / "cxx-clang", BUILD / "cxx-aarch64", BUILD / "cxx"
CROSS = "aarch64-linux-gnu-g++"
EMULATOR = ("qemu-aarch64", "-L", "/usr/aarch64-linux-gnu")
SAMPLES = ROOT / "sample_meshes"
PAIRS = (
    ("box.obj", "box_pushed.stl"),
    ("box.obj", "box_flush.stl"),
    ("l_bracket.obj", "peg_in_notch.ply"),
    ("l_bracket.obj", "peg_in_arm.ply"),
    ("l_bracket.obj", "seed_in_arm.stl"),
    ("kettle.obj", "snowflake.obj"),
    ("needle.stl", "rod.stl"),
    ("cube.off", "open_box.off"),
    ("far_a.obj", "far_b.obj"),
    ("fin_box.obj", "box.obj"),
)


def clang() -> Outcome:
    if shutil.which("clang++") is None:
        return Outcome(FAILED, "clang++ is missing")
    return native_tests(CLANG, "-DCMAKE_BUILD_TYPE=Release", "-DCMAKE_CXX_COMPILER=clang++")


def aarch64() -> Outcome:
    missing = [tool for tool in (CROSS, EMULATOR[0]) if shutil.which(tool) is None]
    if missing:
        return Outcome(FAILED, f"{' and '.join(missing)} missing")
    return native_tests(
        AARCH64,
        "-DCMAKE_BUILD_TYPE=Release",
        "-DCMAKE_SYSTEM_NAME=Linux",
        "-DCMAKE_SYSTEM_PROCESSOR=aarch64",
        f"-DCMAKE_CXX_COMPILER={CROSS}",
        f"-DCMAKE_CROSSCOMPILING_EMULATOR={';'.join(EMULATOR)}",
    )


def dumps(pairs: Sequence[tuple[Path, Path]]) -> Outcome:
    for folder in (HERE, AARCH64):
        jobs = str(os.cpu_count() or 1)
        built = run("cmake", "--build", str(folder), "--target", "pair_dump", "--parallel", jobs)
        if built.state == FAILED:
            return built
    differing = [pair for pair in pairs if not is_the_same(*pair)]
    names = ", ".join(f"{a.name} {b.name}" for a, b in differing)
    return (
        Outcome(FAILED, f"differ: {names}") if differing else Outcome(PASSED, f"{len(pairs)} pairs")
    )


def is_the_same(a: Path, b: Path) -> bool:
    here = dumped([], HERE, a, b)
    there = dumped(EMULATOR, AARCH64, a, b)
    say(f"{a.name} {b.name}: {len(here)} bytes, {'the same' if here == there else 'DIFFERENT'}")
    return here == there


def dumped(emulator: Sequence[str], folder: Path, a: Path, b: Path) -> bytes:
    program = folder / "tests" / "release" / "pair_dump"
    command = [*emulator, str(program), str(a), str(b)]
    return subprocess.run(command, check=True, stdout=subprocess.PIPE).stdout


def main(files: Sequence[str]) -> int:
    if len(files) % 2:
        say("the files come in pairs: A B")
        return 2
    pairs = [(SAMPLES / a, SAMPLES / b) for a, b in PAIRS]
    pairs += [(Path(a), Path(b)) for a, b in zip(files[::2], files[1::2], strict=True)]
    outcomes = [("C++ tests with clang", clang()), ("C++ tests on aarch64", aarch64())]
    outcomes.append(("C++ tests here", native_tests(HERE, "-DCMAKE_BUILD_TYPE=Release")))
    if all(outcome.state != FAILED for _, outcome in outcomes[1:]):
        outcomes.append(("x86-64 and aarch64 agree", dumps(pairs)))
    for title, outcome in outcomes:
        if outcome.state == FAILED:
            say(outcome.printed)
        say(f"{outcome.state:8}{title:40}{outcome.remark}".rstrip())
    return 1 if any(outcome.state == FAILED for _, outcome in outcomes) else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
