"""Suggested fixed bodies as rules in TOML, with the questions that they allow to ask."""

from __future__ import annotations

from typing import TYPE_CHECKING

from satcheck.cli.formats.suggest import RULES_ALONE, quoted
from satcheck.cli.formats.words import counted
from satcheck.scene.rules import Selector

if TYPE_CHECKING:
    from satcheck.audit.suggest_support import SupportTerms


def toml(terms: SupportTerms) -> str:
    """A file of rules alone; the reason of each says that it is to be confirmed."""
    gravity = ", ".join(f"{c:g}" for c in terms.gravity)
    blocks = [f"[statics]\ngravity = [{gravity}]\n"]
    blocks += [
        "\n".join(
            (
                "[[rules]]",
                f"bodies = {quoted(Selector.writable(fixed.body).text)}",
                "mounted = true",
                f"reason = {quoted(f'suggested: {fixed.evidence}; confirm')}\n",
            )
        )
        for fixed in terms.fixed
    ]
    blocks.append('[[rules]]\nbodies = "*"\nsupported = true\n')
    return "\n".join((RULES_ALONE, *blocks))


def remark(terms: SupportTerms) -> str:
    """For standard error."""
    said = f"{counted(len(terms.fixed), 'fixed body', 'fixed bodies')} suggested"
    if terms.known:
        said += f", beside {terms.known:,} that the scene calls static or mounted"
    return f"{said}: confirm each. All other bodies are asked whether they are supported."
