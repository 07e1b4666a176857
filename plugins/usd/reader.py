"""Reads USD (usda, usdc, usdz) with usd-core: a body for each geometric prim, named by its path."""

from __future__ import annotations

import os

from satcheck.plugins.usd.stage import open_stage, said
from satcheck.scene.errors import Refused
from satcheck.scene.loading.extras import imported
from satcheck.scene.loading.raw_mesh import RawScene
from satcheck.scene.loading.readers import File


def read_usd(file: File) -> RawScene:
    """Return the bodies of a stage. Raises Refused."""
    os.environ.setdefault("PXR_WORK_THREAD_LIMIT", "1")  # each thread reserves address space
    tf = imported("pxr.Tf", "usd", "USD files")
    try:
        stage = open_stage(file.location, file.permitted)
        from satcheck.plugins.usd.reading import read_scene  # imports usd-core

        return read_scene(stage, file.options)
    except tf.ErrorException as error:
        raise Refused("bad-record", f"not a valid USD file: {said(error)}") from None
