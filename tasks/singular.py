"""Damping of the joint motion that a task loses near its singularities."""

from __future__ import annotations

from typing import final

import numpy as np

from tasks.kernels.singular import damp_lost, work_size
from wbc import PD, InputError, MotionTask, Robot, Rows, SaturatedPD, State, Task
from wbc.arrays import Array, positive
from wbc.checks import expect
from wbc.compiled import announce
from wbc.rows import allocate_rows
from wbc.settled import Settled

__all__ = ["SingularDamping"]

TINY = float(np.finfo(float).tiny)


@final
class SingularDamping(Settled, Task):
    """Rest for the joint directions in which another task becomes singular.

    With J = U diag(s) V^T of that task, e the state error that its law reacts to and kd
    its damping, row i asks for l_i v_i^T vdot = -l_i kd v_i^T v with

        l_i^2 = (1 - (s_i / (threshold |J|))^2) ((factor |J|)^2 + bend |J| |e|),

    and for nothing where s_i is beyond the threshold. Put it beside the task, on the
    same level: `goal + SingularDamping(goal)`. There it makes of 1 / s the gain
    s / (s^2 + l^2) of a damped inverse, with three differences. The lost directions are
    damped towards rest, not towards zero acceleration, which would leave their velocity
    alone and let the arm swing about its border (Wampler and Leifer 1988). The damping
    grows with the error (Levenberg and Marquardt; Sugihara 2011): it stands for the
    curvature of the error that J alone does not show, so a goal beyond reach pulls no
    harder than the law is stiff. And directions that the task leaves free count as
    singular as its weakest one, as the curvature couples them.

    The rows are rows like others: both families of resolvers take them, no higher level
    feels them, and strict priorities stay exact, which damping within a projector would
    break. They vanish away from singularities, and at rest they ask for nothing: they
    bend no goal that can be reached, but near a singularity tracking lags behind and
    levels below get nothing in directions that are damped.

    Args:
        task: whose singularities; its law must be a `PD` or a `SaturatedPD`. The latter
            bounds what a goal far beyond reach asks for.
        threshold: singular value below which damping sets in, relative to |J|.
        factor: damping at zero error, on the same scale.
        bend: curvature of the error over the joints, relative to |J|; 1/3 covers
            serial arms.
        name: "singular damping" by default.

    Raises:
        InputError: a number is not greater than 0, or the law is none of the two.
    """

    def __init__(
        self,
        task: MotionTask,
        *,
        threshold: float = 0.1,
        factor: float = 0.01,
        bend: float = 1.0 / 3.0,
        name: str = "singular damping",
    ) -> None:
        expect(MotionTask, task=task)
        super().__init__(name, "rad/s", task.frames)
        self.task = task
        self._law()
        self.threshold = positive(threshold, "threshold")
        self.factor = positive(factor, "factor")
        self.bend = positive(bend, "bend")
        self._seen, self._work = allocate_rows(0, 0), np.zeros(0)

    def row_names(self, robot: Robot) -> tuple[str, ...]:
        """One a direction of the joints, from the task's strongest to its weakest."""
        return tuple(f"direction {i + 1}" for i in range(robot.nv))

    def check(self, robot: Robot) -> None:
        """The task fits the robot, and its law is one of the two."""
        self.task.check(robot)
        self._law()
        announce(damp_lost, f"'{self.name}'")

    def update(self, state: State, rows: Rows) -> None:
        """Write the rows."""
        law, (m, n) = self._law(), self._sizes(state.robot)
        if self._seen.A.shape != (m, n):
            self._seen, self._work = allocate_rows(m, n), np.zeros(work_size(m, n))
        seen = self._seen
        for array in seen:
            array[:] = 0.0
        self.task.evaluate(state, seen)
        damp_lost(
            seen.A,
            np.array(state.v),  # one memory layout, so that one compilation serves all
            self.threshold,
            self.factor,
            self.bend,
            float(law.damping.max()),
            self._error(law, seen.error),
            self._work,
            rows,
        )

    def _sizes(self, robot: Robot) -> tuple[int, int]:
        """Numbers of the task's rows and of the joints."""
        return len(self.task.row_names(robot)), robot.nv

    def _error(self, law: PD | SaturatedPD, error: Array) -> float:
        """Norm of the error, no larger than a law that saturates takes it."""
        wish = law.acceleration(error, np.zeros(error.size))
        stiffness = max(float(law.stiffness.max()), TINY)
        return float(np.sqrt(wish @ wish)) / stiffness

    def _law(self) -> PD | SaturatedPD:
        law = self.task.law
        if isinstance(law, PD | SaturatedPD):
            return law
        raise InputError(
            f"'{self.name}' needs a task with a PD or SaturatedPD law, but that of "
            f"'{self.task.name}' is {law!r}."
        )
