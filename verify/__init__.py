"""satcheck.verify: a report's verdicts re-checked from the mesh files, without the solver.

In integers and rationals, on the float64 coordinates as they stand in the files. It shares no code
with what made the report but the readers of files: `satcheck.scene`. The proofs are arguments of a
few lines, each next to the code that checks it, so that it can be read in one sitting, from
`document` (the report) over `findings` and `relations` (what is claimed) to `world` (winding
numbers), `surfaces` (which triangles meet), `cells` (contact) and `exact` (numbers).
"""

from satcheck.report.verification import Checked
from satcheck.verify.document import Verification, verify
from satcheck.verify.exact import Rejected
from satcheck.verify.strict_json import parse

__all__ = ["Checked", "Rejected", "Verification", "parse", "verify"]
