"""satcheck.verify: a report's findings re-checked from the mesh files, without the solver.

It computes in integers and rationals on the float64 coordinates of the files. With the solver it
shares the readers of files (`satcheck.scene`), and how a verdict follows from findings and rules
(`satcheck.report`). Each proof is an argument of a few lines next to the code that checks it. Read
it in this order: `document` (the report), `findings` and `relations` (the claims), `world` (winding
numbers), `surfaces` (which triangles meet), `cells` (contact), `exact` (numbers).
"""

from satcheck.report.verification import Checked, VerificationReport
from satcheck.verify.document import is_certified, verify
from satcheck.verify.exact import Rejected
from satcheck.verify.published import parse

__all__ = ["Checked", "Rejected", "VerificationReport", "is_certified", "parse", "verify"]
