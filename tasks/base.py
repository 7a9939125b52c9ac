"""What the catalogue's tasks share: rows by a compiled kernel, alone or in a stack."""

from __future__ import annotations

from abc import abstractmethod

import numpy as np

from tasks.evaluator import SCRATCH, Code, evaluate_alone, run
from wbc import (
    PD,
    Damper,
    Kernel,
    MotionTask,
    Robot,
    Rows,
    SaturatedPD,
    State,
)
from wbc.arrays import Array, IntArray
from wbc.frames import frame_size
from wbc.kernel import NO_TABLE, WORLD
from wbc.relative import moved, relative
from wbc.settled import Settled

__all__ = ["CatalogueTask", "run_kernel"]


class CatalogueTask(Settled, MotionTask):
    """A motion task whose error, Jacobian and drift come from a compiled kernel.

    Within a stack all such tasks are evaluated by one call; `evaluate` runs the same
    kernel for this task alone.
    """

    code: Code
    moving: Array | None = None
    """A frame that moves by itself, in the place of the world among the frames."""

    @abstractmethod
    def parameters(self, robot: Robot) -> Array:
        """Numbers that the kernel reads."""

    def live_parameters(self, robot: Robot) -> Array:
        """The same for a stack: an array that later changes of the target reach."""
        return self.parameters(robot)

    def table(self, robot: Robot) -> Array:
        """More of them, constant."""
        del robot
        return NO_TABLE

    def joint_indices(self, robot: Robot) -> IntArray | None:
        """For rows that are 1 at one joint and 0 elsewhere (m,): its index."""
        del robot
        return None

    def kernel(self, robot: Robot) -> Kernel | None:
        """The compiled half; None where the law is not one that is compiled."""
        law = self.law
        if not isinstance(law, PD | Damper | SaturatedPD):
            return None
        m = len(self.row_names(robot))
        stiffness = np.zeros(()) if isinstance(law, Damper) else law.stiffness
        return Kernel(
            run,
            int(self.code),
            self.live_parameters(robot),
            self.table(robot),
            np.broadcast_to(stiffness, (m,)),
            np.broadcast_to(law.damping, (m,)),
            law.gains if isinstance(law, SaturatedPD) else None,
            self.joint_indices(robot),
            self.moving,
        )

    def evaluate(self, state: State, out: Rows) -> None:
        """Write the rows."""
        robot = state.robot
        F = self._seen(state)
        run_kernel(self.code, self.parameters(robot), self.table(robot), F, state, out)

    def _seen(self, state: State) -> Array | None:
        """The task's frame, as seen from its second one if it has two."""
        n, flat = state.robot.nv, []
        for name in self.frames:
            if name == WORLD and self.moving is not None:
                flat.append(np.zeros(frame_size(n)))
                moved(self.moving, state.t, flat[-1])
            else:
                flat.append(state.flat(name))
        if len(flat) == 2:
            seen = np.zeros(frame_size(n))
            relative(flat[0], flat[1], seen, np.zeros(SCRATCH), n)
            return seen
        return flat[0] if flat else None


def run_kernel(
    code: Code,
    parameters: Array,
    table: Array,
    F: Array | None,
    state: State,
    out: Rows,
) -> None:
    """Write one task's rows at a state; F is a flat frame."""
    n = state.robot.nv
    evaluate_alone(
        int(code),
        np.array(parameters),  # one memory layout, so that one compilation serves all
        np.array(table),
        np.zeros(frame_size(n)) if F is None else F,
        np.array(state.q),
        np.array(state.v),
        state.t,
        state.dt,
        np.zeros(SCRATCH + n),
        out,
    )
