"""The child process that asks other libraries: what they do to themselves is an answer too."""

from __future__ import annotations

import sys

import numpy as np

from bench.peers.child import answers
from bench.peers.protocol import Body, line_of, pair_of

PEER = """
import os, sys, time
for line in sys.stdin:
    if line == "die\\n": os.abort()
    if line == "hang\\n": time.sleep(60)
    print(line.strip(), flush=True)
"""


def test_a_pair_survives_the_way_to_a_peer_bit_by_bit() -> None:
    body = Body(np.array([[0.1, 1e-300, -2.5], [1 / 3, 0, 1e45], [1, 2, 3]]), np.array([[0, 1, 2]]))
    flat = Body(np.array([[1.0, 2, 3]]), np.zeros((0, 3), np.int64))
    for sent, received in zip((body, flat), pair_of(line_of(body, flat)), strict=True):
        assert np.array_equal(sent.vertices, received.vertices)
        assert np.array_equal(sent.triangles, received.triangles)


def test_crash_hang_and_refusal_are_answers_and_the_next_pair_is_asked() -> None:
    lines = ["1 -0.5 0 0 1", "die", "0 2 1 0 0", "hang", "unsupported", "0 nan nan nan nan"]
    given = list(answers([sys.executable, "-c", PEER], lines, seconds=1.0))
    statuses = [answer.status for answer in given]
    assert statuses == ["ok", "crash", "ok", "hang", "unsupported", "ok"]
    assert (given[0].overlap, given[0].distance, given[0].normal) == (True, -0.5, (0, 0, 1))
    assert np.isnan(given[5].distance)
