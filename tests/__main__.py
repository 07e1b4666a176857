"""Every check of the project: `python -m tests` (what `make test` runs).

Needs satcheck installed with its extra `test`. `python -m tests types pytest` runs just those two.
Steps run two at a time: one that waits, or that uses one core, leaves no core idle. What a step
prints comes when it ends. Exit code 0 when every step passed or could not apply here (said so in
the table), else 1.
"""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
import sysconfig
import time
from collections.abc import Callable, Sequence
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import NamedTuple

from tests.browser.browsers import missing
from tests.links import LINKS, make_links

ROOT = Path(__file__).resolve().parent.parent
BUILD = ROOT / "build"
# Printed by CMakeLists.txt when the compiler has no sanitizers.
NO_SANITIZERS = "SATCHECK_SANITIZE: not available"
PASSED, FAILED, SKIPPED = "passed", "FAILED", "skipped"


# At once.
MOST_STEPS = 2


class Outcome(NamedTuple):
    """printed: by the tools of the step, both streams."""

    state: str
    remark: str = ""
    printed: str = ""


def lint() -> Outcome:
    return run("ruff", "check", ".")


def layout() -> Outcome:
    return run("ruff", "format", "--check", ".")


def types() -> Outcome:
    return run("mypy")


def arrows() -> Outcome:
    return run("lint-imports", "--no-logo", PYTHONPATH=str(LINKS))


def native() -> Outcome:
    """The tests of the library in the installed package: `make test` builds both in one folder."""
    folder = BUILD / str(sys.implementation.cache_tag)
    if not (folder / "CTestTestfile.cmake").exists():
        return Outcome(FAILED, "the C++ tests are not built: make test builds them")
    return ctest(folder)


def sanitized() -> Outcome:
    """-Og: optimised enough to run the sweeps, and the build is a quarter shorter than with -O1."""
    return native_tests(
        BUILD / "cxx-sanitized",
        "-DCMAKE_BUILD_TYPE=Debug",
        "-DSATCHECK_SANITIZE=ON",
        *(["-DCMAKE_CXX_FLAGS=-Og"] if os.name == "posix" else []),
    )


def pytest() -> Outcome:
    """One process a core. Files stay whole: their tests share what is slow to set up. In their
    order: those of few tests, which xdist would put last, hold the longest, as that of Dask."""
    cores = str(os.cpu_count() or 1)
    spread = ("--numprocesses", cores, "--dist", "loadfile", "--no-loadscope-reorder")
    return run(sys.executable, "-m", "pytest", *spread)


def browser() -> Outcome:
    """The page with the 3-D view, in a Chromium where there is one."""
    lacking = missing()
    if lacking is not None:
        return Outcome(SKIPPED, lacking)
    return run(sys.executable, "-m", "pytest", "tests/browser/driven_page.py")


# In the order in which they start: the longest first.
STEPS: dict[str, tuple[str, Callable[[], Outcome]]] = {
    "pytest": ("pytest", pytest),
    "lint": ("ruff check", lint),
    "layout": ("ruff format --check", layout),
    "types": ("mypy --strict", types),
    "arrows": ("import-linter", arrows),
    "native": ("C++ unit tests", native),
    "sanitized": ("C++ unit tests under ASan and UBSan", sanitized),
    "browser": ("the page in Chromium", browser),
}


def native_tests(folder: Path, *options: str) -> Outcome:
    """Configure, build and run the C++ tests, which need no Python."""
    configure = ["cmake", "-S", str(ROOT), "-B", str(folder), *generator(folder)]
    configure += ["-DSATCHECK_PYTHON=OFF", "-DSATCHECK_CXX_TESTS=ON", *options]
    configured = run(*configure)
    if configured.state == FAILED and NO_SANITIZERS in configured.printed:
        return Outcome(SKIPPED, "this compiler has no AddressSanitizer")
    if configured.state == FAILED:
        return configured._replace(remark="cmake could not configure")
    jobs = str(os.cpu_count() or 1)
    built = run("cmake", "--build", str(folder), "--parallel", jobs, "--config", "Release")
    if built.state == FAILED:
        return built
    tested = ctest(folder)
    return tested._replace(printed=built.printed + tested.printed)  # with the warnings


def ctest(folder: Path) -> Outcome:
    tests = ["--test-dir", str(folder), "-C", "Release", "--parallel", str(os.cpu_count() or 1)]
    return run("ctest", *tests, "--output-on-failure", "--no-tests=error")


def generator(folder: Path) -> list[str]:
    """Ninja; on Windows CMake's own choice, which finds the compiler by itself."""
    configured = (folder / "CMakeCache.txt").exists()
    return [] if configured or os.name == "nt" else ["-G", "Ninja"]


def environment(**more: str) -> dict[str, str]:
    """The tools of this Python environment first. Python keeps what it compiles, also where it is
    told not to: thousands of processes import the same modules."""
    path = os.pathsep.join([sysconfig.get_path("scripts"), os.environ.get("PATH", "")])
    ours = {"PATH": path, "UBSAN_OPTIONS": "print_stacktrace=1", "PYTHONDONTWRITEBYTECODE": ""}
    return {**os.environ, **ours, **more}


def run(tool: str, *arguments: str, **variables: str) -> Outcome:
    program = located(tool)
    if program is None:
        return Outcome(FAILED, f"{tool} is missing: pip install '.[test]'")
    done = subprocess.run(
        [program, *arguments],
        cwd=ROOT,
        env=environment(**variables),
        check=False,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        encoding="utf-8",
        errors="replace",
    )
    if done.returncode:
        return Outcome(FAILED, f"exit code {done.returncode}", done.stdout)
    return Outcome(PASSED, printed=done.stdout)


def located(tool: str) -> str | None:
    """Windows looks a program up in the path of the parent, so it is looked up here."""
    return shutil.which(tool, path=environment()["PATH"])


def say(line: str) -> None:
    sys.stdout.write(line + "\n")
    sys.stdout.flush()


def main(wanted: Sequence[str]) -> int:
    unknown = set(wanted) - set(STEPS)
    if unknown:
        say(f"unknown: {', '.join(sorted(unknown))}; the steps are {', '.join(STEPS)}")
        return 2
    make_links(LINKS)
    with ThreadPoolExecutor(MOST_STEPS) as pool:
        running = [pool.submit(timed, name) for name in wanted or STEPS]
        try:
            ended = [step.result() for step in running]
        except KeyboardInterrupt:
            pool.shutdown(cancel_futures=True)
            raise
    say("")
    for title, outcome, seconds in ended:
        say(f"{outcome.state:8}{title:40}{seconds:7.1f} s  {outcome.remark}".rstrip())
    return 1 if any(outcome.state == FAILED for _, outcome, _ in ended) else 0


def timed(name: str) -> tuple[str, Outcome, float]:
    title, step = STEPS[name]
    start = time.monotonic()
    outcome = step()
    say(f"\n--- {title}\n{outcome.printed.rstrip()}")
    return title, outcome, time.monotonic() - start


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
