"""Why a task is not met: which rows hold it back, and what a unit of them is worth.

The optimum of a hierarchy answers linearly to its bounds as long as the same ones stay
active (`response`); from that follows what blocks each task and who pays for each
bound (`findings`), as frozen values (`data`) that print as a table (`text`).
"""

from wbc.explain.data import ActiveBound, Blocker, Explanation, TaskExplanation
from wbc.explain.findings import explain

__all__ = ["ActiveBound", "Blocker", "Explanation", "TaskExplanation", "explain"]
