"""Ranks of a hierarchy: what is left, what is redundant, what conflicts."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.testing import assert_allclose

import tasks
from tests.arms import HOME, seven_axis
from tests.catalogue import (
    CATALOGUE,
    RawRows,
    hierarchy_of,
    random_equalities,
    random_state,
)
from tests.tolerances import SOUND
from wbc import (
    HierarchicalQP,
    Hierarchy,
    InputError,
    NullSpace,
    SolverError,
    State,
    UnknownName,
    allocate_rows,
    resolve,
)

X, Y, Z = np.eye(3)
TIP = "tip"


def home() -> State:
    return seven_axis().state(HOME)


def rim(state: State):
    F = state.frame(TIP)
    cylinder = tasks.Cylinder(F.p - 0.03 * F.R[:, 1], -F.R[:, 2], 0.03)
    return tasks.rim_grasp(TIP, cylinder)


@pytest.mark.parametrize("metric", ["kinetic", "joint"])
def test_the_rim_leaves_two_of_seven_and_names_its_redundant_rows(metric):
    state = home()
    limits = tasks.TorqueLimits() + tasks.JointLimits()
    analysis = (limits >> rim(state) >> tasks.Posture(HOME)).analyse(
        state, metric=metric
    )
    top, middle, last = analysis.levels
    assert (top.rows, top.inequalities, top.rank, top.free) == (0, 14, 0, 7)
    assert (middle.rows, middle.rank, middle.free) == (7, 5, 2)
    assert middle.singular_values.shape == (7,)
    assert (middle.singular_values[5:] < 1e-9).all()
    assert [(row.task, row.row) for row in middle.redundant] == [
        ("rim approach", "tilt 2"),
        ("rim closing", "angle"),
    ]
    assert not any(row.above for row in middle.redundant)
    assert (last.rows, last.rank, last.free, analysis.free) == (7, 2, 0, 0)
    assert len(last.redundant) == 5  # the arm stands in its posture: all agree
    assert last.conflicts == ()


def test_a_row_that_disagrees_with_those_above_is_named_with_them():
    p = home().frame(TIP).p
    stack = tasks.PointOnPoint(TIP, p) >> tasks.FramePosition(TIP, p + 0.1 * X)
    level = stack.analyse(home()).level("tip position")
    (conflict,) = level.conflicts
    assert (conflict.task, conflict.row) == ("tip position", "x")
    assert conflict.on == ("tip on point/x",)
    assert conflict.above
    assert conflict.mismatch == pytest.approx(10.0)  # stiffness 100 times 0.1 m
    assert conflict.unit == "m/s^2"
    assert [row.row for row in level.redundant] == ["y", "z"]
    assert all(row.above for row in level.redundant)


def test_rows_that_disagree_within_a_level_are_a_conflict_of_its_own():
    p = home().frame(TIP).p
    both = tasks.PointOnPoint(TIP, p) + 2.0 * tasks.FramePosition(TIP, p + 0.1 * X)
    (level,) = Hierarchy(both).analyse(home()).levels
    (conflict,) = level.conflicts
    assert not conflict.above
    assert conflict.mismatch == pytest.approx(10.0)


@pytest.mark.parametrize("seed", range(20))
def test_ranks_are_those_of_the_solvers(seed):
    rng = np.random.default_rng(seed)
    levels = random_equalities(rng, 7)
    state = random_state(seven_axis(), rng)
    hierarchy = hierarchy_of(levels)
    analysis = hierarchy.analyse(state)
    solution = resolve(state, hierarchy, HierarchicalQP())
    assert [level.rank for level in analysis.levels] == list(solution.ranks)
    stacked = np.vstack([A for A, _, _ in levels])
    assert analysis.free == 7 - np.linalg.matrix_rank(stacked)
    for level in analysis.levels:
        dependent = len(level.redundant) + len(level.conflicts)
        assert dependent == level.rows - level.rank


@pytest.mark.parametrize("seed", range(10))
def test_a_conflict_is_there_exactly_where_a_residual_is(seed):
    rng = np.random.default_rng(seed)
    state, levels = random_state(seven_axis(), rng), random_equalities(rng, 7)
    hierarchy = hierarchy_of(levels)
    x = resolve(state, hierarchy, HierarchicalQP()).acceleration
    analysis = hierarchy.analyse(state)
    for level, (A, b, _) in zip(analysis.levels, levels, strict=True):
        missed = float(np.linalg.norm(A @ x - b))
        assert bool(level.conflicts) == (missed > 1e-6)


def test_the_metrics_measure_what_they_say():
    state = home()
    task = tasks.PointOnPoint(TIP, X)
    J = state.frame(TIP).J[:3]
    joint = Hierarchy(task).analyse(state, metric="joint").levels[0]
    assert_allclose(joint.singular_values, np.linalg.svd(J)[1])
    kinetic = Hierarchy(task).analyse(state).levels[0]
    mobility = J @ np.linalg.solve(state.M, J.T)
    squares = np.sort(np.linalg.eigvalsh(mobility))[::-1]
    assert_allclose(kinetic.singular_values**2, squares)


def test_torque_rows_are_counted_over_accelerations():
    class Torque(RawRows):
        space = "torque"

    state = home()
    wanted = Torque("torque", np.eye(7)[:2], [1.0, 2.0])
    (level,) = Hierarchy(wanted).analyse(state, metric="joint").levels
    assert_allclose(level.singular_values, np.linalg.svd(state.M[:2])[1])


def test_a_larger_tolerance_forgives_a_pose_that_nearly_holds():
    """Parallel implies perpendicular, but only where it holds."""
    axis = tasks.Line(X, home().frame(TIP).R[:, 2])
    tool, across = tasks.Line(0 * X, Z, on=TIP), tasks.Line(0 * X, Y, on=TIP)
    both = tasks.ParallelLines(tool, axis) + tasks.PerpendicularLines(across, axis)
    assert Hierarchy(both).analyse(home()).levels[0].rank == 2
    near = seven_axis().state(HOME + 1e-5 * np.arange(7))
    assert Hierarchy(both).analyse(near).levels[0].rank == 3
    assert Hierarchy(both).analyse(near, tolerance=1e-3).levels[0].rank == 2


@pytest.mark.parametrize("away", [0.0, 1e-9, 1e-6, 1e-3, 1.0])
def test_the_rim_has_rank_five_wherever_the_gripper_is(away):
    rng = np.random.default_rng(23)
    for _ in range(5):
        state = seven_axis().state(HOME + away * rng.normal(size=7))
        (level,) = Hierarchy(rim(home())).analyse(state).levels
        assert (level.rows, level.rank, level.free) == (7, 5, 2)
        assert (level.singular_values[5:] < 1e-13).all()


def test_the_text_says_it_all():
    state = home()
    p = state.frame(TIP).p
    stack = rim(state) >> tasks.FramePosition(TIP, p + 0.1 * Z, name="lift")
    text = str(stack.analyse(state))
    assert "seven: 7 degrees of freedom" in text
    assert "level  rows  rank  left" in text
    assert "redundant: rim closing/angle" in text
    assert "conflict with levels above: lift/" in text
    assert "m/s^2" in text
    assert "as the solvers see them" in text
    assert max(map(len, text.splitlines())) < 200


def test_bad_input_is_refused():
    stack = Hierarchy(tasks.PointOnPoint(TIP, X))
    with pytest.raises(UnknownName, match=r"unknown metric 'mass'.*kinetic, joint"):
        stack.analyse(home(), metric="mass")
    with pytest.raises(InputError, match="tolerance"):
        stack.analyse(home(), tolerance=0.0)
    with pytest.raises(UnknownName, match="unknown frame 'tipp'"):
        Hierarchy(tasks.PointOnPoint("tipp", X)).analyse(home())
    with pytest.raises(UnknownName, match="unknown task 'nobody'"):
        stack.analyse(home()).level("nobody")
    with pytest.raises(SolverError, match="'bad' wrote a row that is not finite"):
        Hierarchy(RawRows("bad", np.full((1, 7), np.nan), [1.0])).analyse(home())


# ------------------------------------------------------------------------- soundness


@pytest.mark.parametrize(
    "resolver", [HierarchicalQP(), NullSpace()], ids=lambda r: r.name
)
@pytest.mark.parametrize("redundant", [False, True])
def test_what_stands_below_does_not_disturb_geometry_above(resolver, redundant):
    """With redundant rows, and near where they become so, as well as without."""
    rng = np.random.default_rng(17)
    for away in (0.0, 1e-7, 1e-4, 0.3):
        v = rng.normal(size=7)
        state = seven_axis().state(HOME + away * rng.normal(size=7), v)
        above = rim(home()) if redundant else tasks.PointOnPoint(TIP, X)
        alone = resolve(state, Hierarchy(above), resolver).acceleration
        below = [tasks.Posture(10.0 * rng.normal(size=7)), tasks.Damping(rate=50.0)]
        analysed = []
        for low in (below[0], below[0] + 3.0 * below[1]):
            found = resolve(state, above >> low, resolver).acceleration
            analysed.append(found)
        for task, _ in Hierarchy(above).levels[0].terms:
            A = _rows(task, state)
            size = 1.0 + np.abs(A) @ np.abs(np.array([alone, *analysed])).max(axis=0)
            for found in analysed:
                assert (np.abs(A @ (found - alone)) <= SOUND * size).all()


def _rows(task, state: State) -> np.ndarray:
    rows = allocate_rows(len(task.row_names(state.robot)), state.robot.nv)
    task.update(state, rows)
    return rows.A.copy()


def test_every_motion_task_of_the_catalogue_can_be_analysed():
    rng = np.random.default_rng(1)
    for kind, entry in CATALOGUE.items():
        state = random_state(seven_axis(), rng, 0.4)
        on = ("world",) if issubclass(kind, tasks.geometry.Constraint) else ()
        task = entry.make(state, rng, False, *on).task
        (level,) = Hierarchy(task).analyse(state).levels
        rows = len(task.row_names(state.robot))
        assert level.rows + level.inequalities == rows, kind
        if kind is not tasks.SingularDamping:  # has rows of zeros away from trouble
            assert level.rank == level.rows, kind
