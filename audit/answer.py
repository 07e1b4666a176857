"""What a check answers about a pair before a rule judges it: the relation and the figures."""

from __future__ import annotations

from typing import TYPE_CHECKING

from msgspec import Struct

from satcheck.report.report import Quality, Relation

if TYPE_CHECKING:
    from satcheck.audit.figures.depth import Depth
    from satcheck.audit.figures.gap import Gap
    from satcheck.audit.figures.thickness import Thickness
    from satcheck.audit.figures.touch_band import Band
    from satcheck.audit.figures.volume import CommonVolume
    from satcheck.report.components import Components
    from satcheck.report.contacts import Contacts


class Answer(Struct, frozen=True):
    """relation: with the touch band. exact_relation: without it; None: not proven.

    quality: of the weakest of relation, depth and gap. gap: of bodies without a common interior.
    band: of an overlap. depth, thickness, volume, contacts and components are None if they were not
    requested.
    """

    relation: Relation
    exact_relation: Relation | None
    quality: Quality
    reason: str | None = None
    gap: Gap | None = None
    band: Band | None = None
    depth: Depth | None = None
    thickness: Thickness | None = None
    volume: CommonVolume | None = None
    contacts: Contacts | None = None
    components: Components | None = None
