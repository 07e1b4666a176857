"""What a reader says about a hostile file."""

from __future__ import annotations

import os
import sys

import pytest

from satcheck.core.errors import SatcheckError
from satcheck.scene import load_scene

needs_links = pytest.mark.skipif(sys.platform == "win32", reason="links need a privilege")


needs_pipes = pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="there are no named pipes")


def issues(path, **options):
    return [(issue.code, issue.message) for issue in load_scene([path], **options).issues]


def issues_of(folder, name, content):
    (folder / name).write_bytes(content)
    return [code for code, _ in issues(folder / name)]


def code_of(folder, name, content):
    (folder / name).write_bytes(content)
    try:
        return next(iter(code for code, _ in issues(folder / name)), "read")
    except SatcheckError as error:
        return error.code


def write(folder, name, content):
    (folder / name).write_bytes(content)
    return folder / name
