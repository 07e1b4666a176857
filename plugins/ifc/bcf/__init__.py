"""Findings as topics for coordination programs: BCF 3.0 (buildingSMART, BCF-XML), with bcf-client.

One topic for each group of findings, with a view of each pair. Its import raises Refused
(`missing-extra`) without the library.
"""

from __future__ import annotations

from satcheck.scene.files.readers import imported

imported("bcf", "ifc", "BCF files")
