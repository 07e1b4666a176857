"""Pin the answers of a satcheck command: `python -m tests.contract SATCHECK [FOLDER]`.

FOLDER: where the pinned files go.  [default: the folder that the tests read]
"""

from __future__ import annotations

import os
import subprocess
import sys
import tempfile
from pathlib import Path

from tests.contract.cases import Arguments
from tests.contract.runs import PINNED, pin


def main(satcheck: str, folder: str = str(PINNED)) -> None:
    with tempfile.TemporaryDirectory() as cache:
        environment = {**os.environ, "PYTHONUTF8": "1", "SATCHECK_CACHE_DIR": cache}

        def run(arguments: Arguments, folder: Path) -> tuple[int, str]:
            done = subprocess.run(
                [satcheck, *arguments],
                cwd=folder,
                env=environment,
                stdout=subprocess.PIPE,
                stderr=subprocess.DEVNULL,
                check=False,
            )
            return done.returncode, done.stdout.decode("utf-8")

        pin(run, Path(folder))


if __name__ == "__main__":
    if len(sys.argv) not in (2, 3):
        sys.exit(__doc__)
    main(*sys.argv[1:])
