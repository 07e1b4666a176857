"""What the registry knows of USD files: usda, usdc and usdz, read with usd-core. A body for each
geometric prim, named by its path."""

from __future__ import annotations

import os
import sys
from typing import Annotated, Literal

from msgspec import Meta

from satcheck.scene.document import Document
from satcheck.scene.errors import Refused
from satcheck.scene.files.readers import GEOMETRY, File, Option, Reader, imported

_MOST = sys.float_info.max
TIME = Option("time", Annotated[float, Meta(ge=-_MOST, le=_MOST)], "the time code")
PURPOSE = Option(
    "purpose",
    Annotated[tuple[Literal["render", "proxy", "guide"], ...], Meta(min_length=1)],
    "what is drawn: render, proxy, guide",
)


def read_usd(file: File) -> Document:
    """Return the bodies of a stage. Raises Refused."""
    os.environ.setdefault("PXR_WORK_THREAD_LIMIT", "1")  # each thread reserves address space
    tf = imported("pxr.Tf", "usd", "USD files")
    from satcheck.plugins.usd.reading import Reading  # imports usd-core
    from satcheck.plugins.usd.stage import open_stage, said

    try:
        return Reading(open_stage(file), file.options).scene()
    except tf.ErrorException as error:
        raise Refused("bad-record", f"not a valid USD file: {said(error)}") from None


READERS = (
    Reader(
        "usd",
        "USD",
        (".usd", ".usda", ".usdc", ".usdz"),
        "satcheck.plugins.usd.readers:read_usd",
        kind="document",
        options=(TIME, GEOMETRY, PURPOSE),
        marks=(b"PK\x03\x04",),
        by_name=True,
    ),
)
