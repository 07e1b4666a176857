"""One pair, asked in every other way."""

from __future__ import annotations

import zlib
from collections.abc import Callable, Iterator, Sequence

import numpy as np
from numpy.random import Generator

from satcheck.audit.asked.settings import Settings
from satcheck.audit.check import Progress
from satcheck.core.errors import SatcheckError
from satcheck.scene import Scene
from satcheck.scene.other_unit import require_in_range
from satcheck.studies.stability.answer import ask, touch_band
from satcheck.studies.stability.comparison import compare
from satcheck.studies.stability.meshings import noisy, reordered, retessellated
from satcheck.studies.stability.placements import in_motion, reaxed, scaled, swapped, translated
from satcheck.studies.stability.result import FamilyResult, Sample, Stability
from satcheck.studies.stability.variant import FAMILIES, Family, Question, Variant, body

Make = Callable[[Question, int, Generator], Iterator[Variant]]

_MAKERS: dict[Family, Make] = {
    "scale": scaled,
    "order": reordered,
    "axes": reaxed,
    "swap": swapped,
    "translation": translated,
    "retessellation": retessellated,
    "motion": in_motion,
    "noise": noisy,
}
_NOTHING_TO_ASK: dict[Family, str] = {
    "scale": "no power of two leaves the coordinates within the numeric range",
    "translation": "no translation was found that adds to every coordinate exactly",
    "retessellation": "no edge was found that could be split or turned",
}


def probe(
    scene: Scene,
    samples: int = 4,
    seed: int = 0,
    settings: Settings | None = None,
    families: Sequence[Family] = FAMILIES,
    progress: Progress | None = None,
) -> Stability:
    """Ask about the two bodies of a scene again, `samples` ways a family.

    The same seed asks the same questions. settings: depth, part_* and cache are followed; the touch
    band and the clearance are not, because the exact relation and every gap are asked for.
    Raises SatcheckError (`not-a-pair`) unless the scene holds two mesh files, in place.
    """
    settings = settings or Settings()
    question = _question(scene)
    as_asked = Variant("scale", "as asked", body("a", question.a), body("b", question.b))
    asked = ask(as_asked, settings)
    done, total = 1, 1 + samples * len(families) - (samples - 1) * ("swap" in families)
    results = []
    for family in families:
        found = []
        for variant in _MAKERS[family](question, samples, _generator(seed, family)):
            answer = ask(variant, settings)
            found.append(Sample(variant.how, answer, compare(asked, answer, variant)))
            done += 1
            if progress is not None:
                progress(done, total)
        skipped = None if found else _NOTHING_TO_ASK.get(family)
        results.append(FamilyResult(family, tuple(found), skipped))
    band = touch_band((as_asked.a, as_asked.b))
    return Stability(question.a.path, question.b.path, seed, asked, tuple(results), band)


def _question(scene: Scene) -> Question:
    scene.require_in_space("stability is asked about meshes only")
    require_in_range(scene)
    placed = [body for body in scene.bodies if body.transform is not None]
    if len(scene.bodies) != 2 or scene.unreadable or placed:
        raise SatcheckError("not-a-pair", "stability is asked about two mesh files of one unit")
    scene.require_one_unit()
    a, b = (body.file for body in scene.bodies)
    return Question(a, b)


def _generator(seed: int, family: Family) -> Generator:
    """Of its own for each family, so that the questions of one do not depend on the others."""
    return np.random.default_rng([seed, zlib.crc32(family.encode())])
