"""The stage `certificate`: the evidence for a finding. The results of the solver serve as hints.

Nothing here is trusted: `satcheck.verify` judges each certificate before it goes into a report.
"""

from satcheck.audit.stages.certificate.certificate import with_certificate

__all__ = ["with_certificate"]
