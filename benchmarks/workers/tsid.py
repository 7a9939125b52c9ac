"""TSID with its fastest solver: hard limits, pose and posture by weight."""

from __future__ import annotations

import numpy as np
import pinocchio as pin
import tsid.tsid_pywrap as tsid

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


class Tsid:
    """The formulation of the examples that come with it."""

    def __init__(self, job: Job, model: pin.Model) -> None:
        kind = tsid.RootJointType.FIXED_BASE_SYSTEM
        self.robot = tsid.RobotWrapper(model, kind, False)
        self.formulation = tsid.InverseDynamicsFormulationAccForce(
            "tsid", self.robot, False
        )
        self.n, self.t = model.nv, 0.0
        home = np.array(job.home)
        self.formulation.computeProblemData(0.0, home, np.zeros(self.n))
        self._limits(job, model)
        self._tasks(job, home)
        problem = self.formulation
        self.solver = tsid.SolverHQuadProgFast("solver")
        self.solver.resize(problem.nVar, problem.nEq, problem.nIn)

    def _limits(self, job: Job, model: pin.Model) -> None:
        joints = tsid.TaskJointPosVelAccBounds("joints", self.robot, job.dt, False)
        joints.setTimeStep(job.dt)  # the constructor doubles it
        joints.setPositionBounds(model.lowerPositionLimit, model.upperPositionLimit)
        joints.setVelocityBounds(model.velocityLimit)
        joints.setAccelerationBounds(np.array(job.acceleration))
        self.formulation.addMotionTask(joints, 1.0, 0, 0.0)
        torques = tsid.TaskActuationBounds("torques", self.robot)
        limit = np.array(model.effortLimit) * job.torque_share
        torques.setBounds(-limit, limit)
        self.formulation.addActuationTask(torques, 1.0, 0, 0.0)
        self.bounds = (joints, torques)

    def _tasks(self, job: Job, home: Array) -> None:
        (kp, kp_posture), (weight, weight_posture) = job.stiffness, job.weights
        self.poses, self.samples = [], []
        for tip in job.tips:
            task = tsid.TaskSE3Equality(f"{tip} pose", self.robot, tip)
            task.setKp(np.full(6, kp))
            task.setKd(np.full(6, twice_root(kp)))
            task.useLocalFrame(False)
            self.formulation.addMotionTask(task, weight, 1, 0.0)
            self.poses.append(task)
            self.samples.append(tsid.TrajectorySample(12, 6))
        self.posture = tsid.TaskJointPosture("posture", self.robot)
        self.posture.setKp(np.full(self.n, kp_posture))
        self.posture.setKd(np.full(self.n, twice_root(kp_posture)))
        still = tsid.TrajectorySample(self.n)
        still.value(home)
        self.posture.setReference(still)
        self.formulation.addMotionTask(self.posture, weight_posture, 1, 0.0)

    def aim(self, t: float, targets: list[Target]) -> None:
        """Move the references."""
        self.t = t
        for task, sample, target in zip(self.poses, self.samples, targets, strict=True):
            sample.value(np.concatenate([target.p, target.R.T.ravel()]))
            sample.derivative(np.concatenate([target.v, np.zeros(3)]))
            sample.second_derivative(np.concatenate([target.a, np.zeros(3)]))
            task.setReference(sample)

    def tick(self, q: Array, v: Array, *felt: Wrenches) -> Array:
        """From (q, v) to the torques."""
        problem = self.formulation.computeProblemData(self.t, q, v)
        self.solution = self.solver.solve(problem)
        if self.solution.status != 0:
            raise Failed(f"QP status {self.solution.status}")
        return self.formulation.getActuatorForces(self.solution)

    def acceleration(self) -> Array:
        """Of the last tick."""
        return np.array(self.formulation.getAccelerations(self.solution))


def open_loop(job: Job, kind: str) -> Loop:
    """The job under TSID."""
    model = load_model(job)
    return Loop(job, Tsid(job, model), model)


if __name__ == "__main__":
    serve(open_loop, ("tsid", "pin", "numpy"))
