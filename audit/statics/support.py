"""The answers to the body rules of a scene, as a part of its report."""

from __future__ import annotations

from time import perf_counter_ns
from typing import TYPE_CHECKING

import numpy as np

from satcheck.audit.bodies import UNUSED_RULE, PlacedBodies
from satcheck.audit.settings import Settings
from satcheck.audit.statics.answers import (
    NOT_DECIDED,
    NOT_LET_GO,
    answer_to,
    asks,
    doubt_about,
    finding,
    island_report,
    issues_of,
    rule_report,
    vector,
)
from satcheck.audit.statics.equilibrium import Island, require_solver
from satcheck.audit.statics.flush_edges import without_flush_edges
from satcheck.audit.statics.graph import graph_of
from satcheck.audit.statics.islands import Outcome, outcome_of
from satcheck.audit.statics.margins import margins_of
from satcheck.audit.statics.subjects import subjects_of, terms_for
from satcheck.audit.statics.touching import Contact, contacts_of
from satcheck.core.errors import SatcheckError
from satcheck.core.risky_steps import not_for_lack_of_memory
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
    Question,
    Statics,
    SupportedBody,
    SupportFinding,
)
from satcheck.scene.statics import QUESTIONS, BodyRule, disagreeing_axes, terms_of

if TYPE_CHECKING:
    from satcheck.audit.statics.near import Floats
    from satcheck.scene import Body, Scene, Unreadable

NOT_SOLVED = Outcome("open", "open", {}, {}, reason="no rule asks about a body of this island")


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
        self.subjects = subjects_of(
            [bodies.placed[k] for k in index], [everything[k] for k in index]
        )
        free = [subject.body for subject in self.subjects if subject.fixed is None]
        self.terms = terms_for(scene, free)
        alone = not self.unusable
        contacts, self.pairs = contacts_of(self.subjects, self.terms.tolerance, settings)
        self.contacts = without_flush_edges(contacts, self.subjects, self.terms)
        self.graph = graph_of(self.subjects, self.contacts, alone=alone)
        self.outcomes = self._outcomes(alone)
        self.margins = margins_of(
            [
                self._standing(members, outcome)
                for members, outcome in zip(self.graph.islands, self.outcomes, strict=True)
            ]
        )
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
            if any(asks(self.subjects[k].terms) for k in members)
            else NOT_SOLVED
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
            return Outcome("open", "open", {}, {}, reason=reason)

    def _standing(self, members: list[int], outcome: Outcome) -> Island | None:
        """An island with forces, if a rule asks about one of its bodies: at its strict contacts, if
        these suffice."""
        asked = any(asks(self.subjects[k].terms) for k in members)
        weighed = outcome.weighed
        if not asked or outcome.tolerant != "yes" or weighed is None:
            return None
        if outcome.strict != "yes":
            return weighed.island
        return weighed.island.among(np.flatnonzero(weighed.strict))

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
            islands=tuple(
                island_report(members, self.subjects, outcome, margins)
                for members, outcome, margins in zip(
                    self.graph.islands, self.outcomes, self.margins, strict=True
                )
            ),
            findings=tuple(self._findings()),
            pairs=self.pairs,
            microseconds=self.microseconds,
        )

    def issues(self, scene: Scene, statics: Statics) -> list[Issue]:
        """Bodies that fail or are open, doubts about the bodies, and rules that select none."""
        members = scene.in_order()
        failed = issues_of(statics.findings, UNSUPPORTED, SUPPORT_OPEN)
        return [*failed, *_axes(scene), *self._small(), *self._unused(members)]

    def _small(self) -> list[Issue]:
        tolerance = self.terms.tolerance
        return [
            Issue(
                TOLERANCE_LARGE,
                "warning",
                subject.id,
                None,
                f"{subject.id} is smaller than the tolerance of contacts {tolerance:.3g}",
            )
            for subject in self.subjects
            if subject.fixed is None and subject.body.diagonal < tolerance
        ]

    def _unused(self, members: list[Body | Unreadable]) -> list[Issue]:
        return [
            Issue(
                UNUSED_RULE,
                "warning",
                None,
                rule.file,
                f"{rule.name}: the rule selects no body",
                rule.line,
            )
            for rule in self.rules
            if not rule.bodies.select(members)
        ]

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
            for question in QUESTIONS:
                rule = subject.terms.asks(question)
                if rule is not None:
                    findings.append(self._finding(k, question, rule))
        for id_, (reason, terms) in self.unusable.items():
            for question in QUESTIONS:
                rule = terms.asks(question)
                if rule is not None:
                    findings.append(
                        finding(id_, question, rule, terms.value("severity"), "open", reason)
                    )
        return findings

    def _finding(self, k: int, question: Question, rule: BodyRule) -> SupportFinding:
        subject, graph = self.subjects[k], self.graph
        outcome = None if subject.fixed is not None else self.outcomes[graph.island[k]]
        answer, reason = answer_to(question, k, subject, graph, outcome)
        margins = None if subject.fixed is not None else self.margins[graph.island[k]]
        if answer == "yes" and outcome is not None:
            reason = doubt_about(margins)
            undecided = margins is None or margins.squeezed is None
            if reason is None and undecided and outcome.beside_walls:
                answer = "open" if question == "stable" else "yes"
                reason = NOT_LET_GO if margins is None else NOT_DECIDED
        return finding(subject.id, question, rule, subject.terms.value("severity"), answer, reason)


def _axes(scene: Scene) -> list[Issue]:
    if not disagreeing_axes(scene):
        return []
    message = "glTF files are y-up, and gravity is assumed along -z: state [statics] gravity"
    return [Issue(GRAVITY_ASSUMED, "warning", None, None, message)]
