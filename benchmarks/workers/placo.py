"""PlaCo's dynamics solver: one QP, hard limits, pose and posture by weight."""

from __future__ import annotations

import numpy as np
import placo

from benchmarks.jobs import Job
from benchmarks.workers.loop import (
    Array,
    Failed,
    Loop,
    Target,
    Wrenches,
    load_model,
    twice_root,
)
from benchmarks.workers.serve import serve


class Placo:
    """Fixed base by its mask; braking as strong as the job allows."""

    def __init__(self, job: Job) -> None:
        self.robot = placo.RobotWrapper(job.urdf, placo.Flags.ignore_collisions)
        self.solver = placo.DynamicsSolver(self.robot)
        self.solver.mask_fbase(True)
        self.solver.dt = job.dt
        self.solver.torque_cost = 1e-8
        self.q = self.robot.state.q.copy()
        self.qd = self.robot.state.qd.copy()
        self.q[7:] = job.home
        self.robot.state.q = self.q
        self.robot.update_kinematics()
        self._limits(job)
        self._tasks(job)

    def _limits(self, job: Job) -> None:
        solver, names = self.solver, list(self.robot.joint_names())
        effort = np.array(self.robot.model.effortLimit)[6:]
        for name, stop, torque in zip(names, job.acceleration, effort, strict=True):
            solver.set_qdd_safe(name, stop)
            solver.set_torque_limit(name, torque * job.torque_share)
        solver.enable_joint_limits(True)
        solver.enable_velocity_limits(True)
        solver.enable_torque_limits(True)

    def _tasks(self, job: Job) -> None:
        (kp, kp_posture), (weight, weight_posture) = job.stiffness, job.weights
        self.positions, self.orientations = [], []
        for tip in job.tips:
            X = self.robot.get_T_world_frame(tip)
            position = self.solver.add_position_task(tip, X[:3, 3])
            orientation = self.solver.add_orientation_task(tip, X[:3, :3])
            for task in (position, orientation):
                task.configure(f"{tip} pose", "soft", weight)
                task.kp, task.kd = kp, twice_root(kp)
            self.positions.append(position)
            self.orientations.append(orientation)
        posture = self.solver.add_joints_task()
        names = self.robot.joint_names()
        posture.set_joints(dict(zip(names, map(float, job.home), strict=True)))
        posture.configure("posture", "soft", weight_posture)
        posture.kp, posture.kd = kp_posture, twice_root(kp_posture)

    def aim(self, t: float, targets: list[Target]) -> None:
        """Move the references."""
        for task, turn, target in zip(
            self.positions, self.orientations, targets, strict=True
        ):
            task.target_world = target.p
            task.dtarget_world = target.v
            task.ddtarget_world = target.a
            turn.R_world_frame = target.R

    def tick(self, q: Array, v: Array, *felt: Wrenches) -> Array:
        """From (q, v) to the torques."""
        self.q[7:], self.qd[6:] = q, v
        state = self.robot.state
        state.q, state.qd = self.q, self.qd
        self.robot.update_kinematics()
        self.result = self.solver.solve(False)
        if not self.result.success:
            raise Failed("QP infeasible")
        return self.result.tau[6:]

    def acceleration(self) -> Array:
        """Of the last tick."""
        return self.result.qdd[6:]


def open_loop(job: Job, kind: str) -> Loop:
    """The job under PlaCo."""
    return Loop(job, Placo(job), load_model(job))


if __name__ == "__main__":
    serve(open_loop, ("placo", "pin", "numpy"))
