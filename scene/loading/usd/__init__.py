"""Reads USD (usda, usdc, usdz) with usd-core: a body for each geometric prim, named by its path."""

from __future__ import annotations

import os
from pathlib import Path

from satcheck.scene.errors import MeshFileError
from satcheck.scene.loading.extras import imported
from satcheck.scene.loading.raw_mesh import RawScene
from satcheck.scene.loading.usd.stage import open_stage, said
from satcheck.scene.permitted import Permitted
from satcheck.scene.read_options import ReadOptions


def read_usd(location: Path, options: ReadOptions, permitted: Permitted) -> RawScene:
    """permitted: where its layers may lie. Raises MeshFileError."""
    os.environ.setdefault("PXR_WORK_THREAD_LIMIT", "1")  # each thread reserves address space
    tf = imported("pxr.Tf", "usd", "USD files")
    try:
        stage = open_stage(location, permitted)
        from satcheck.scene.loading.usd.reading import read_scene  # imports usd-core

        return read_scene(stage, options)
    except tf.ErrorException as error:
        raise MeshFileError("bad-record", f"not a valid USD file: {said(error)}") from None
