"""The probe: one pair in all its variants."""

from __future__ import annotations

from collections.abc import Sequence

from satcheck.audit.checked_pairs import Progress
from satcheck.audit.request.settings import Settings
from satcheck.core.errors import SatcheckError
from satcheck.scene import Scene
from satcheck.studies.pair import pair_of
from satcheck.studies.stability.answer import ask
from satcheck.studies.stability.comparison import compare
from satcheck.studies.stability.result import FamilyResult, Sample, Stability
from satcheck.studies.stability.variant import FAMILIES, Family, Question, Variant, body
from satcheck.studies.stability.variants import NO_VARIANTS, variants


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
    given = Variant("scale", "as given", body("a", question.a), body("b", question.b))
    answer = ask(given, settings)
    done, total = 1, 1 + samples * len(families) - (samples - 1) * ("swap" in families)
    results = []
    for family in families:
        family_samples = []
        for variant in variants(family, question, samples, seed):
            varied = ask(variant, settings)
            family_samples.append(Sample(variant.how, varied, compare(answer, varied, variant)))
            done += 1
            if progress is not None:
                progress(done, total)
        skipped = None if family_samples else NO_VARIANTS.get(family)
        results.append(FamilyResult(family, tuple(family_samples), skipped))
    band = pair_of((given.a, given.b), Settings()).tolerance
    return Stability(question.a.path, question.b.path, seed, answer, tuple(results), band)


def _question(scene: Scene) -> Question:
    scene.require_in_space("stability is asked about meshes only")
    placed = [body for body in scene.bodies if body.transform is not None]
    if len(scene.bodies) != 2 or scene.unreadable or placed:
        raise SatcheckError("not-a-pair", "stability is asked about two mesh files of one unit")
    scene.require_one_unit()
    a, b = (body.file for body in scene.bodies)
    return Question(a, b)
