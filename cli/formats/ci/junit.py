"""JUnit XML, as CI servers read it: a test suite for each report, a test case for each pair that it
lists, and for each answer about the support of a body.

A finding that fails is a failure, an undecided question an error, a finding that a baseline holds
is skipped; others pass. The pairs that the report does not list are one test case together, and so
is an asset without pairs. An incomplete report has an error case at least.
"""

from __future__ import annotations

from typing import TYPE_CHECKING
from xml.etree import ElementTree

from satcheck.audit.messages import answer_message, kind_of
from satcheck.audit.words import counted
from satcheck.cli.formats.ci.problems import stops_pass
from satcheck.cli.formats.summary import config_line, summary_line
from satcheck.cli.output import harmless, issue_line
from satcheck.report.baseline import HELD
from satcheck.report.regions import InsideFinding
from satcheck.report.report import OUTSIDE_REGION, UNSUPPORTED
from satcheck.report.verdict import fails, is_unmet

if TYPE_CHECKING:
    from collections.abc import Iterator

    from satcheck.cli.formats.registry import Reports
    from satcheck.report.report import BodyAnswer, Finding, Report


def render(reports: Reports) -> Iterator[str]:
    yield '<?xml version="1.0" encoding="UTF-8"?>\n<testsuites>'
    for name, report in reports.items():
        suite = _suite(name, report)
        ElementTree.indent(suite, level=1)
        yield f"\n  {ElementTree.tostring(suite, encoding='unicode')}"
    yield "\n</testsuites>\n"


def _suite(name: str, report: Report) -> ElementTree.Element:
    suite = ElementTree.Element("testsuite", name=_clean(name))
    if report.config is not None:
        properties = ElementTree.SubElement(suite, "properties")
        value = _clean(config_line(report.config))
        ElementTree.SubElement(properties, "property", name="config", value=value)
    files = {body.id: body.file for body in report.bodies}
    for finding in report.findings:
        case = _case(suite, files[finding.a], f"{finding.a} and {finding.b}")
        _judge(case, finding, report)
    for answer in report.answers:
        case = _case(suite, files[answer.body], f"{answer.body} is {answer.question}")
        _judge_answer(case, answer, report)
    if report.truncated is not None:
        pairs = counted(report.truncated.pairs, "more pair")
        _case(suite, name, f"{pairs}: {report.truncated.reason}")
    for issue in report.issues:  # those about answers have a case above
        if stops_pass(issue):
            case = _case(suite, issue.file or name, issue.body or issue.file or issue.code)
            _say(case, "error", issue.code, issue_line(issue))
    if report.summary.verdict == "incomplete" and suite.find("testcase/error") is None:
        _say(_case(suite, name, "incomplete"), "error", "incomplete", summary_line(report))
    if suite.find("testcase") is None:
        _case(suite, name, "no pair")
    ElementTree.SubElement(suite, "system-out").text = _clean(summary_line(report))
    for name, kind in (("failures", "failure"), ("errors", "error"), ("skipped", "skipped")):
        suite.set(name, str(len(suite.findall(f"testcase/{kind}"))))
    suite.set("tests", str(len(suite.findall("testcase"))))
    return suite


def _case(suite: ElementTree.Element, file: str, name: str) -> ElementTree.Element:
    attributes = {"classname": _clean(file), "name": _clean(name)}
    return ElementTree.SubElement(suite, "testcase", attributes)


def _judge(case: ElementTree.Element, finding: Finding, report: Report) -> None:
    text = finding.message
    if finding.baseline_state in HELD:
        ElementTree.SubElement(case, "skipped", message=_clean(text))
    elif finding.undecided is not None:
        _say(case, "error", "undecided", text)
    elif fails(finding, report.settings.fail_on):
        _say(case, "failure", kind_of(finding), text)


def _judge_answer(case: ElementTree.Element, answer: BodyAnswer, report: Report) -> None:
    text = answer_message(answer)
    if answer.answer == "open":
        _say(case, "error", "undecided", text)
    elif is_unmet(answer, report.settings.fail_on):
        inside = isinstance(answer, InsideFinding)
        _say(case, "failure", OUTSIDE_REGION if inside else UNSUPPORTED, text)


def _say(case: ElementTree.Element, name: str, kind: str, text: str) -> None:
    ElementTree.SubElement(case, name, type=kind, message=_clean(text))


def _clean(text: str) -> str:
    """Without characters that XML 1.0 cannot hold, and without others that are not for people."""
    return "\n".join(map(harmless, text.split("\n")))
