"""Do bodies hit while they move? The sweep of a pair; see docs/motion.md."""

from satcheck.audit.motion.sweep import sweep as sweep
