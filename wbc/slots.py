"""Where a tick's compiled code finds things: the table of addresses of a stack.

A call with many arrays costs more than a small solve. So a stack lists once where its
arrays lie, and the compiled tick (`wbc.compiled`) is handed this table.
"""

from __future__ import annotations

JOINTS, ROWS, TASKS, FRAMES = 0, 1, 2, 3
"""Slots that hold numbers of things."""
RAW, BANDS, WEIGHTS, TORQUE = 4, 5, 6, 7
INERTIA, BIAS, VDOT_ROWS, Y_ROWS, BOUNDS, FACTOR, INVERSE = range(8, 15)
"""Addresses of a stack's arrays."""
PROGRAM, GAINS, POINTERS, CONSTANTS, BLOCKS, JACOBIAN, SCRATCH = range(15, 22)
"""Of what compiled tasks read and write."""
SOLVER = 22
"""Of the table of the solver's memory."""
GUARDED = 23
"""Number of rows on top that bound torques alone, and so can always be kept."""
JOINT = 24
"""Address of a stack's array of the joints that its rows are about, where it is one."""
SIZE = 25

SOLVED, UNSOLVED, UNMEASURED, NOT_POSITIVE, BAD_ROW, NOT_FINITE, BEYOND = range(7)
"""How a tick can end: well; with the best point of a solver out of iterations; before
it began, at a measurement that is not finite; with an inertia that is none; with a row
that is not finite; with a torque that is not, or beyond a bound that could be kept."""
