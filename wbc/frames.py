"""Frames of the robot from Pinocchio's joint quantities, in one compiled pass."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, NamedTuple, final

import numpy as np
import pinocchio as pin

from wbc.arrays import Array, IntArray
from wbc.compiled import compiled, inner
from wbc.pointers import address_of, floats_at

__all__ = [
    "FrameState",
    "Frames",
    "cross_into",
    "frame_at",
    "frame_size",
    "update_frame",
]

POINTERS = 6
"""Addresses of a frame: R, p, v, omega, a, alpha of its joint."""
SCRATCH = 24


class FrameState(NamedTuple):
    """A frame F of the robot at one instant, seen from the world W.

    Attributes:
        p: (3,) p_WF, origin [m].
        R: (3, 3) R_WF.
        V: (6,) twist V_WF = J v, [linear; angular], world axes at F's origin.
        drift: (6,) dJ/dt v, the classical acceleration at zero joint acceleration.
        J: (6, n) Jacobian of the twist.
    """

    p: Array
    R: Array
    V: Array
    drift: Array
    J: Array


def frame_size(n: int) -> int:
    """Numbers in a `FrameState` of a robot of n joints."""
    return 24 + 6 * n


@inner
def frame_at(flat: Array, n: int) -> FrameState:
    """The frame that lies in a flat array, as views."""
    return FrameState(
        flat[0:3],
        flat[3:12].reshape((3, 3)),
        flat[12:18],
        flat[18:24],
        flat[24 : 24 + 6 * n].reshape((6, n)),
    )


@final
class Frames:
    """Some frames of a robot, kept as flat blocks that kernels read.

    Args:
        model: the Pinocchio model.
        data: its Data; `crba` in the world's axes and `nonLinearEffects` must have
            run on it before the frames are updated.
        names: one a frame.
        indices: Pinocchio's index of each.

    Attributes:
        blocks: (f, 24 + 6 n) one `FrameState` a row.
        pointers: (f, 6) where the joints' quantities lie.
        constants: (f, 15 + n) pose of the frame in its joint, gravity, support.
        jacobian: address of the joints' Jacobian.
    """

    __slots__ = (
        "_alive", "_spare", "blocks", "constants", "jacobian", "names", "pointers",
    )  # fmt: skip

    def __init__(
        self,
        model: pin.Model,
        data: pin.Data,
        names: Sequence[str],
        indices: Sequence[int],
    ) -> None:
        n, f = model.nv, len(names)
        self.names = tuple(names)
        self.blocks = np.zeros((f, frame_size(n)))
        self.pointers = np.zeros((f, POINTERS), np.int_)
        self.constants = np.zeros((f, 15 + n))
        self._spare = np.zeros(SCRATCH)
        self._alive: list[Any] = [data, data.J]
        self.jacobian = address_of(data.J)
        for i, index in enumerate(indices):
            frame = model.frames[index]
            joint = frame.parentJoint  # 0 for a frame that does not move
            X, V, A = data.oMi[joint], data.v[joint], data.a_gf[joint]
            views = [
                X.rotation,
                X.translation,
                V.linear,
                V.angular,
                A.linear,
                A.angular,
            ]
            self._alive += [X, V, A, *views]
            self.pointers[i] = [address_of(view) for view in views]
            constants = self.constants[i]
            constants[:9] = frame.placement.rotation.ravel()
            constants[9:12] = frame.placement.translation
            constants[12:15] = model.gravity.linear
            constants[[14 + j for j in model.supports[joint] if j > 0]] = 1.0

    def update(self) -> Array:
        """Rewrite the blocks; returns them."""
        blocks, pointers, constants = self.blocks, self.pointers, self.constants
        _update_all(blocks, pointers, constants, self.jacobian, self._spare)
        return blocks


@compiled
def _update_all(
    blocks: Array, pointers: IntArray, constants: Array, jacobian: int, scratch: Array
) -> None:
    """Write the blocks of all frames."""
    n = constants.shape[1] - 15
    for i in range(blocks.shape[0]):
        update_frame(blocks[i], pointers[i], constants[i], jacobian, scratch, n)


@inner
def update_frame(
    flat: Array,
    pointers: IntArray,
    constants: Array,
    jacobian: int,
    scratch: Array,
    n: int,
) -> FrameState:
    """Write one frame's block.

    With r from the joint's to the frame's origin: V = v + omega x r, and the classical
    acceleration a + omega x v + alpha x r + omega x (omega x r). Pinocchio's a_gf is
    the spatial acceleration less gravity, in the joint's axes.
    """
    F = frame_at(flat, n)
    R = floats_at(pointers[0], 9)
    p, r, v = floats_at(pointers[1], 3), scratch[0:3], scratch[3:6]
    omega, a, alpha = scratch[6:9], scratch[9:12], scratch[12:15]
    _turn(R, constants[9:12], r)
    _turn(R, floats_at(pointers[2], 3), v)
    _turn(R, floats_at(pointers[3], 3), omega)
    _turn(R, floats_at(pointers[4], 3), a)
    _turn(R, floats_at(pointers[5], 3), alpha)
    spin, swing, lift = scratch[15:18], scratch[18:21], scratch[21:24]
    cross_into(omega, r, spin)
    for i in range(3):
        v[i] += spin[i]
    cross_into(omega, v, swing)
    cross_into(alpha, r, lift)
    for i in range(3):
        F.p[i] = p[i] + r[i]
        F.V[i], F.V[3 + i] = v[i], omega[i]
        F.drift[i] = a[i] + constants[12 + i] + swing[i] + lift[i]
        F.drift[3 + i] = alpha[i]
        for j in range(3):
            F.R[i, j] = 0.0
            for k in range(3):
                F.R[i, j] += R[i + 3 * k] * constants[3 * k + j]
    _jacobian(F, floats_at(jacobian, 6 * n), constants, n)
    return F


@inner
def _jacobian(F: FrameState, J: Array, constants: Array, n: int) -> None:
    """Columns of the joints that move the frame, from the world's origin to it."""
    p0, p1, p2 = F.p[0], F.p[1], F.p[2]
    for j in range(n):
        on, c = constants[15 + j], 6 * j
        w0, w1, w2 = on * J[c + 3], on * J[c + 4], on * J[c + 5]
        F.J[0, j] = on * J[c] + w1 * p2 - w2 * p1
        F.J[1, j] = on * J[c + 1] + w2 * p0 - w0 * p2
        F.J[2, j] = on * J[c + 2] + w0 * p1 - w1 * p0
        F.J[3, j], F.J[4, j], F.J[5, j] = w0, w1, w2


@inner
def _turn(R: Array, x: Array, out: Array) -> None:
    """Out = R x, with R (9,) stored by columns."""
    for i in range(3):
        out[i] = R[i] * x[0] + R[i + 3] * x[1] + R[i + 6] * x[2]


@inner
def cross_into(a: Array, b: Array, out: Array) -> None:
    """Out = a x b."""
    out[0] = a[1] * b[2] - a[2] * b[1]
    out[1] = a[2] * b[0] - a[0] * b[2]
    out[2] = a[0] * b[1] - a[1] * b[0]
