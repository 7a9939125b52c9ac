"""Pinocchio and MuJoCo on one model file: every disagreement, by name."""

from sims.audit.comparison import audit
from sims.audit.result import Audit, Check, Finding

__all__ = ["Audit", "Check", "Finding", "audit"]
