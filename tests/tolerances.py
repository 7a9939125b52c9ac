"""Every tolerance of the core's tests, named once."""

from __future__ import annotations

# Two resolvers on one stack of equalities, relative to the acceleration.
AGREEMENT = 1e-8
# A certificate of a stack of equalities, and of one with inequalities everywhere.
PROOF_OF_EQUALITIES = 1e-8
PROOF_OF_INEQUALITIES = 1e-6
# Of the compiled solver, on anything, levels scaled to unit norm.
PROOF = 1e-8
# What counts as disturbing a higher level, relative to its rows and targets.
SOUND = 1e-9
# Two laws, or a law and a closed form, on the same level; relative.
SAME = 1e-8
# A hand-computed optimum, absolute.
BY_HAND = 1e-9
# scipy's general minimisers stop here; absolute, on problems of size one.
BRUTE_FORCE = 1e-6
# A point that is this far from the optimum must be refused.
REFUSED = 1e-6
# Central differences: step, and what is left of them relative to 1 + the value.
STEP = 1e-5
DIFFERENCE = 2e-6
# A map that is affine, differenced with a unit step; relative to 1 + the value.
AFFINE = 1e-11
# Limits in a tick: relative to the torque limit, and in rad, rad/s.
TORQUE = 1e-9
JOINT = 1e-9
# Round-off of arithmetic on numbers of size one.
ROUND_OFF = 1e-12
# An interpolated curve against its closed form: length and radius, relative.
CURVE = 1e-7
# A pose against a closed form, and the error of constraints that it holds [m, rad].
POSE = 1e-7
