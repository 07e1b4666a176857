"""Certificates: evidence for a finding, gathered with what the solver found as a hint.

Nothing here is trusted. What it makes is handed to `satcheck.verify` before it gets into a report.
"""

from satcheck.audit.certify.certificate import certified
from satcheck.audit.certify.values import NoCertificate

__all__ = ["NoCertificate", "certified"]
