"""The answers to the body rules of a scene, as a part of its report."""

from __future__ import annotations

from time import perf_counter_ns
from typing import TYPE_CHECKING

from satcheck.audit.bodies import UNUSED_RULE, PlacedBodies
from satcheck.audit.settings import Settings
from satcheck.audit.statics.answers import (
    answer_to,
    asked_of,
    finding,
    issues_of,
    rule_report,
    vector,
)
from satcheck.audit.statics.equilibrium import require_solver
from satcheck.audit.statics.islands import Outcome, graph_of, left_open, outcome_of
from satcheck.audit.statics.margins import with_margins
from satcheck.audit.statics.subjects import subject_of, terms_for
from satcheck.audit.statics.touching import Contact, contacts_of, without_flush_edges
from satcheck.core.errors import SatcheckError
from satcheck.core.steps import not_for_lack_of_memory
from satcheck.report.report import (
    GRAVITY_ASSUMED,
    SUPPORT_OPEN,
    TOLERANCE_LARGE,
    UNSUPPORTED,
    Issue,
)
from satcheck.report.statics import (
    BodyContact,
    ContactPoint,
    FirstMotion,
    Statics,
    SupportedBody,
    SupportFinding,
)
from satcheck.scene.statics import QUESTIONS, disagreeing_axes, terms_of

if TYPE_CHECKING:
    from satcheck.audit.statics.near import Floats
    from satcheck.scene import Scene

NOT_ASKED = "no rule asks about a body of this island"


class Support:
    """What was found about the bodies of a scene. unusable: id -> why a body cannot be used."""

    def __init__(self, scene: Scene, bodies: PlacedBodies, settings: Settings) -> None:
        """Raises SatcheckError: `missing-extra`; `units-unknown` if bodies have no common unit."""
        if settings.planar is not None:
            raise SatcheckError("planar-only", "rules of support need bodies in space: no --planar")
        require_solver()
        scene.require_one_unit()
        started = perf_counter_ns()
        self.rules = scene.body_rules
        members = scene.in_order()
        everything = terms_of(members, scene.body_rules)
        index = [k for k in bodies.placed if not everything[k].value("region")]
        self.unusable = {
            body.id: (body.reason, everything[k]) for k, body in bodies.unusable.items()
        }
        self.subjects = [subject_of(bodies.placed[k], everything[k]) for k in index]
        free = [subject.body for subject in self.subjects if subject.fixed is None]
        self.terms = terms_for(scene, free)
        alone = not self.unusable
        contacts, self.pairs = contacts_of(self.subjects, self.terms.tolerance, settings)
        self.contacts = without_flush_edges(contacts, self.subjects, self.terms)
        self.graph = graph_of(self.subjects, self.contacts, alone=alone)
        self.outcomes = with_margins(self._outcomes(alone))
        self.microseconds = (perf_counter_ns() - started) / 1000.0

    def _outcomes(self, alone: bool) -> list[Outcome]:
        """One for each island. Islands that no rule asks about, and those in the air, are not
        solved."""
        by_island: list[list[tuple[int, Contact]]] = [[] for _ in self.graph.islands]
        for index, contact in enumerate(self.contacts):
            of_both = {self.graph.island.get(contact.a), self.graph.island.get(contact.b)}
            for island in of_both - {None}:
                assert island is not None
                by_island[island].append((index, contact))
        return [
            self._outcome(members, contacts, alone)
            if any(asked_of(self.subjects[k].terms) for k in members)
            else left_open(members, self.subjects, NOT_ASKED)
            for members, contacts in zip(self.graph.islands, by_island, strict=True)
        ]

    def _outcome(
        self, members: list[int], contacts: list[tuple[int, Contact]], alone: bool
    ) -> Outcome:
        """A failure leaves the island open, so that the others are still decided."""
        try:
            return outcome_of(members, self.subjects, contacts, self.terms, alone=alone)
        except Exception as error:  # noqa: BLE001 what failed is open, with the reason
            not_for_lack_of_memory(error)
            reason = f"internal error: {type(error).__name__}: {error}"
            return left_open(members, self.subjects, reason)

    def stated(self) -> Statics:
        names = dict.fromkeys(
            rule.name for rule in self.rules if any(getattr(rule, q) for q in QUESTIONS)
        )
        forces = {key: force for outcome in self.outcomes for key, force in outcome.forces.items()}
        return Statics(
            gravity=self.terms.gravity,
            friction=self.terms.friction,
            tolerance=self.terms.tolerance,
            stated=self.terms.stated,
            asked_by=tuple(names),
            rules=tuple(map(rule_report, self.rules)),
            bodies=tuple(self._body(k) for k in range(len(self.subjects))),
            contacts=tuple(self._contact(k, forces) for k in range(len(self.contacts))),
            islands=tuple(outcome.stated for outcome in self.outcomes),
            findings=tuple(self._findings()),
            pairs=self.pairs,
            microseconds=self.microseconds,
        )

    def issues(self, scene: Scene, statics: Statics) -> list[Issue]:
        """Bodies that fail or are open, doubts about the bodies, and rules that select none."""
        found = issues_of(statics.findings, UNSUPPORTED, SUPPORT_OPEN)
        if disagreeing_axes(scene):
            why = "glTF files are y-up, and gravity is assumed along -z: state [statics] gravity"
            found.append(Issue(GRAVITY_ASSUMED, "warning", None, None, why))
        tolerance = self.terms.tolerance
        for subject in self.subjects:
            if subject.fixed is None and subject.body.diagonal < tolerance:
                why = f"{subject.id} is smaller than the tolerance of contacts {tolerance:.3g}"
                found.append(Issue(TOLERANCE_LARGE, "warning", subject.id, None, why))
        members = scene.in_order()
        for rule in self.rules:
            if not rule.bodies.select(members):
                why = f"{rule.name}: the rule selects no body"
                found.append(Issue(UNUSED_RULE, "warning", None, rule.file, why, rule.line))
        return found

    def _body(self, k: int) -> SupportedBody:
        subject, graph = self.subjects[k], self.graph
        island = graph.island.get(k)
        motion = None if island is None else self.outcomes[island].motions.get(k)
        return SupportedBody(
            id=subject.id,
            fixed=subject.fixed,
            mass=subject.mass,
            centre=None
            if subject.mass is None or subject.centre is None
            else vector(subject.centre),
            island=island,
            floating=graph.floating[k],
            held_by=tuple(self.subjects[n].id for n in graph.touching[k]),
            chain=tuple(self.subjects[n].id for n in graph.chains[k]),
            motion=None if motion is None else FirstMotion(vector(motion[:3]), vector(motion[3:])),
        )

    def _contact(self, k: int, forces: dict[tuple[int, int], Floats]) -> BodyContact:
        contact = self.contacts[k]
        one, other = self.subjects[contact.a], self.subjects[contact.b]
        points = contact.points
        return BodyContact(
            a=one.id,
            b=other.id,
            touch=contact.touch,
            friction=self.terms.friction_of(one.terms, other.terms),
            complete=contact.complete,
            points=tuple(
                ContactPoint(
                    vector(points.at[n]),
                    vector(points.normals[n]),
                    bool(points.strict[n]),
                    vector(forces[k, n]) if (k, n) in forces else None,
                )
                for n in range(len(points))
            ),
        )

    def _findings(self) -> list[SupportFinding]:
        findings = []
        for k, subject in enumerate(self.subjects):
            island = self.graph.island.get(k)
            outcome = None if island is None else self.outcomes[island]
            for question, rule in asked_of(subject.terms):
                answer, reason = answer_to(question, k, self.graph, outcome)
                findings.append(finding(subject.id, question, rule, subject.terms, answer, reason))
        for id_, (why, terms) in self.unusable.items():
            for question, rule in asked_of(terms):
                findings.append(finding(id_, question, rule, terms, "open", why))
        return findings
