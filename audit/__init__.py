"""satcheck.audit: checks the pairs of a scene, and makes the report."""

from satcheck.audit.check import check
from satcheck.audit.settings import Settings
from satcheck.report.report import Finding, Report

__all__ = ["Finding", "Report", "Settings", "check"]
