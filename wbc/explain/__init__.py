"""Why a task is not met: which rows hold it back, and what a unit of them is worth.

The optimum of a hierarchy answers linearly to its bounds as long as the same ones stay
active (`response`); from that follows what blocks each task and who pays for each
bound (`findings`), as frozen values (`data`) that print as a table (`text`). Which
tasks come and go while hierarchies change is told by `fading`, and what a level would
reach without those above, and which of them took the difference, by `strictness`.
"""

from wbc.explain.data import ActiveBound, Blocker, Explanation, TaskExplanation
from wbc.explain.fading import Fading
from wbc.explain.findings import explain
from wbc.explain.strictness import LevelCost, StrictnessCost, strictness_cost

__all__ = [
    "ActiveBound",
    "Blocker",
    "Explanation",
    "Fading",
    "LevelCost",
    "StrictnessCost",
    "TaskExplanation",
    "explain",
    "strictness_cost",
]
