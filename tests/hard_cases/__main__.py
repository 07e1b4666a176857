"""The table of the hard cases: `python -m tests.hard_cases [--seeds N]`."""

from __future__ import annotations

import argparse
import sys

from tests.hard_cases.score import table
from tests.hard_cases.suite import all_scores


def main() -> int:
    parser = argparse.ArgumentParser(prog="python -m tests.hard_cases", description=__doc__)
    parser.add_argument("--seeds", type=int, default=1, help="judge the suites of seeds 0 to N - 1")
    arguments = parser.parse_args()
    scores = all_scores(range(arguments.seeds))
    failures = [failure for score in scores for failure in score.failures]
    sys.stderr.writelines(f"{failure}\n" for failure in failures)
    sys.stdout.write(table(scores) + "\n")
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main())
