"""The sweep of a pair: whether moving bodies hit each other; see docs/scenes.md."""

from satcheck.audit.motion.sweep import sweep as sweep
