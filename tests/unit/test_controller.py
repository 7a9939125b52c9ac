"""The controller: its fallback, its checks, and what its solutions answer."""

from __future__ import annotations

import copy
import pickle

import numpy as np
import pytest

from tasks import Damping, FramePosition, JointLimits, Posture, TorqueLimits
from tests.arms import seven_axis, six_axis
from tests.catalogue import RawRows
from wbc import (
    PD,
    Controller,
    Damper,
    HierarchicalQP,
    InputError,
    ModelError,
    MotionTask,
    NullSpace,
    Resolver,
    Robot,
    SolverError,
    StaleError,
    Status,
    UnknownName,
    WeightedQP,
    resolve,
)
from wbc.resolver import Answer, Solver

N = 7
HOME = seven_axis().q_home
STILL = np.zeros(N)


class Double(Resolver):
    """A resolver that does what a test wants."""

    name = "double"

    def __init__(self, act) -> None:
        self.act = act

    def start(self, stack):
        double = self

        class Doubled(Solver):
            def solve(self) -> Answer:
                vdot = double.act(stack)
                return Answer(vdot, (1,), Status.SOLVED)

        return Doubled()


def failing(error: Exception) -> Double:
    def act(stack):
        raise error

    return Double(act)


def controller(resolver: Resolver | None = None) -> Controller:
    return Controller(
        seven_axis(), TorqueLimits() + JointLimits() >> Posture(), resolver
    )


def assert_safe(solution, robot: Robot) -> None:
    assert np.isfinite(solution.torque).all()
    assert (np.abs(solution.torque) <= robot.tau_max).all()


# ------------------------------------------------------------------- a normal tick


@pytest.mark.parametrize(
    "resolver", [HierarchicalQP(), NullSpace(), NullSpace("tsid"), WeightedQP()]
)
def test_every_resolver_holds_the_home_posture_by_gravity_compensation(resolver):
    robot = seven_axis()
    solution = Controller(robot, Posture(), resolver)(HOME, STILL)
    assert solution.status is Status.SOLVED
    gravity = robot.state(HOME).gravity()
    np.testing.assert_allclose(solution.torque, gravity, rtol=0, atol=1e-9)


def test_the_torque_gives_the_acceleration_that_is_reported():
    robot = seven_axis()
    solution = Controller(robot, Posture(HOME + 0.3))(HOME, STILL + 0.1)
    state = robot.state(HOME, STILL + 0.1)
    np.testing.assert_allclose(
        solution.torque, state.M @ solution.acceleration + state.h, rtol=0, atol=1e-9
    )


def test_lists_serve_as_measurements():
    assert controller()(HOME.tolist(), [0.0] * N).ok


@pytest.mark.parametrize("kind", [np.float32, np.int64, object, ">f8"])
def test_any_real_numbers_serve_as_measurements(kind):
    wanted = controller()(STILL, STILL).torque
    np.testing.assert_allclose(controller()(*2 * [STILL.astype(kind)]).torque, wanted)


@pytest.mark.parametrize("name", ["q", "v"])
@pytest.mark.parametrize(
    "odd",
    [
        STILL + 1j,
        (STILL + 1j).astype(object),
        [np.complex128(1j)] * N,
        STILL.astype("datetime64[s]"),
        STILL.astype("timedelta64[s]"),
        STILL.astype(str),
        ["0"] * N,
    ],
    ids=["complex", "objects", "list", "dates", "durations", "texts", "strings"],
)
def test_what_numpy_would_bend_into_numbers_is_refused_by_name(odd, name):
    with pytest.raises(InputError, match=f"^{name} is not an array of numbers"):
        controller()(**{"q": HOME, "v": STILL, name: odd})


def test_a_measurement_is_copied():
    """Arrays of a subclass, or of any layout, too."""
    q = np.ma.masked_array(HOME[::-1].copy())[::-1]
    expected = controller()(HOME, STILL).torque
    np.testing.assert_allclose(controller()(q, STILL).torque, expected, atol=1e-12)


def test_a_single_task_serves_as_a_hierarchy():
    assert Controller(seven_axis(), Posture())(HOME, STILL).ok


def test_time_reaches_the_tasks():
    seen = []

    class Clock(MotionTask):
        def evaluate(self, state, out):
            seen.append(state.t)

    task = Clock("clock", "s", ("t",), Damper(1.0))
    Controller(seven_axis(), task >> Posture())(HOME, STILL, 2.5)
    assert seen == [2.5]


def test_a_measured_wrench_reaches_the_tasks():
    seen = []

    class Feeler(MotionTask):
        def evaluate(self, state, out):
            seen.append(state.wrench("wrist"))

    task = Feeler("feeler", "N", ("f",), Damper(1.0))
    Controller(seven_axis(), task >> Posture())(
        HOME, STILL, wrenches={"wrist": [0, 0, -5.0, 0, 0, 0]}
    )
    np.testing.assert_array_equal(seen[0], [0, 0, -5.0, 0, 0, 0])


def test_a_wrench_that_was_not_measured_names_those_that_were():
    state = seven_axis().state(HOME, wrenches={"wrist": np.zeros(6)})
    with pytest.raises(UnknownName, match=r"unknown force sensor 'elbow'.*wrist"):
        state.wrench("elbow")


def test_the_measurement_is_copied():
    q, v = HOME.copy(), STILL.copy()
    solution = controller()(q, v)
    before = solution.certificate().worst, solution.torque.copy()
    q += 1.0
    v += 1.0
    assert solution.certificate().worst == before[0]
    np.testing.assert_array_equal(solution.torque, before[1])


def test_the_text_names_robot_tasks_and_resolver():
    text = repr(Controller(seven_axis(), Posture(), NullSpace("tsid")))
    assert "seven" in text
    assert "Posture('posture')" in text
    assert "nullspace:tsid" in text


# -------------------------------------------------------------- sensors that are wrong


@pytest.mark.parametrize("bad", [np.nan, np.inf, -np.inf])
@pytest.mark.parametrize("where", ["q", "v", "both", "all"])
def test_a_measurement_that_is_not_finite_falls_back(bad, where):
    robot, control = seven_axis(), controller()
    q, v = HOME.copy(), STILL.copy()
    if where in ("q", "both", "all"):
        q[1] = bad
    if where in ("v", "both", "all"):
        v[2] = bad
    if where == "all":
        q[:], v[:] = bad, bad
    solution = control(q, v)
    assert solution.status is Status.SENSOR_INVALID
    assert not solution.ok
    assert solution.message == "a measurement is not finite"
    assert control.failures == 1
    assert_safe(solution, robot)


def test_infinities_of_both_signs_fall_back_without_a_warning():
    q = HOME.copy()
    q[0], q[1] = np.inf, -np.inf
    assert controller()(q, STILL).status is Status.SENSOR_INVALID


def test_a_time_that_is_not_finite_falls_back():
    assert controller()(HOME, STILL, np.nan).status is Status.SENSOR_INVALID


def test_a_wrench_that_is_not_finite_falls_back():
    solution = controller()(HOME, STILL, wrenches={"wrist": np.full(6, np.nan)})
    assert solution.status is Status.SENSOR_INVALID


def test_lost_positions_are_held_by_the_last_known_gravity():
    robot, control = seven_axis(), controller()
    q = HOME + 0.2
    bad = controller_loses(control, q)
    np.testing.assert_allclose(bad.torque, robot.state(q).gravity(), rtol=0, atol=1e-9)


def controller_loses(control: Controller, q):
    """Velocities go first, at q; then positions as well."""
    control(q, np.full(N, np.nan))
    return control(np.full(N, np.nan), np.full(N, np.nan))


def test_the_fallback_is_gravity_compensation_at_rest():
    robot = seven_axis()
    solution = controller(failing(SolverError("no")))(HOME, STILL)
    np.testing.assert_allclose(
        solution.torque, robot.state(HOME).gravity(), rtol=0, atol=1e-12
    )


def test_the_fallback_brakes_the_robot():
    robot, control = seven_axis(), controller(failing(SolverError("no")))
    q, v = HOME.copy(), 0.3 * np.ones(N)
    before = v @ robot.state(q, v).M @ v
    for _ in range(500):
        state = robot.state(q, v)
        a = np.linalg.solve(state.M, control(q, v).torque - state.h)
        v = v + 1e-3 * a
        q = q + 1e-3 * v
    after = v @ robot.state(q, v).M @ v
    assert after < 1e-2 * before


def test_the_fallback_keeps_the_torque_limits_at_any_speed():
    solution = controller(failing(SolverError("no")))(HOME, np.full(N, 1e6))
    assert_safe(solution, seven_axis())


# -------------------------------------------------------------- solvers that are wrong


@pytest.mark.parametrize(
    "error",
    [
        SolverError("level 2 failed", 1),
        ModelError("the inertia matrix is not positive definite."),
        np.linalg.LinAlgError("SVD did not converge"),
    ],
)
def test_a_solver_that_fails_falls_back_and_says_why(error):
    control = controller(failing(error))
    solution = control(HOME, STILL)
    assert solution.status is Status.SOLVER_FAILED
    assert solution.message == str(error)
    assert control.failures == 1
    assert_safe(solution, seven_axis())


@pytest.mark.parametrize("bad", [np.nan, np.inf, -np.inf])
def test_a_solver_that_answers_without_numbers_falls_back(bad):
    control = controller(Double(lambda stack: np.full(N, bad)))
    solution = control(HOME, STILL)
    assert solution.status is Status.SOLVER_FAILED
    assert "not finite" in solution.message
    assert_safe(solution, seven_axis())


def test_a_task_that_writes_nan_falls_back():
    task = RawRows("broken", np.full((1, N), np.nan), [0.0])
    for resolver in (HierarchicalQP(), NullSpace()):
        control = Controller(seven_axis(), task >> Posture(), resolver)
        solution = control(HOME, STILL)
        assert solution.status is Status.SOLVER_FAILED
        assert_safe(solution, seven_axis())


def test_a_velocity_that_overflows_falls_back():
    for resolver in (HierarchicalQP(), NullSpace()):
        solution = controller(resolver)(HOME, np.full(N, 1e200))
        assert solution.status is Status.SOLVER_FAILED
        assert_safe(solution, seven_axis())


def test_failures_are_counted_and_good_ticks_are_not():
    control = controller()
    for q in (HOME, HOME * np.nan, HOME, HOME * np.nan):
        control(q, STILL)
    assert control.failures == 2


def test_the_robot_is_controlled_again_once_the_sensor_is_back():
    control = controller()
    control(HOME * np.nan, STILL)
    assert control(HOME, STILL).status is Status.SOLVED


def test_an_error_of_the_program_is_not_taken_for_a_failed_solve():
    with pytest.raises(ZeroDivisionError):
        controller(failing(ZeroDivisionError("a bug")))(HOME, STILL)


# ------------------------------------------------------------------------- bad input


@pytest.mark.parametrize(
    ("q", "v"),
    [(HOME[:3], STILL), (HOME, STILL[:3]), (HOME[None], STILL), (0.0, STILL)],
)
def test_a_measurement_of_the_wrong_shape_raises(q, v):
    with pytest.raises(InputError, match=r"q and v have shapes .*; need \(7,\)"):
        controller()(q, v)


@pytest.mark.parametrize("dt", [0.0, -1e-3, np.nan, np.inf])
def test_a_period_that_is_not_positive_is_refused(dt):
    with pytest.raises(InputError, match="dt must be finite and greater than 0"):
        Controller(seven_axis(), Posture(), dt=dt)


def test_what_is_no_robot_is_refused():
    with pytest.raises(InputError, match="expected a Robot, got 'racer'"):
        Controller("racer", Posture())


def test_what_is_no_task_is_refused():
    with pytest.raises(InputError, match="expected a task, got None"):
        Controller(seven_axis(), None)


def test_a_posture_for_another_robot_is_refused():
    with pytest.raises(InputError, match="was it made for another robot"):
        Controller(six_axis(), Posture(HOME))


def test_a_frame_of_another_robot_is_refused_with_those_that_exist():
    task = FramePosition("tip", [0.5, 0.0, 0.5])
    with pytest.raises(UnknownName, match=r"unknown frame 'tip'.*torch_tip"):
        Controller(six_axis(), task)


def test_joints_of_another_robot_are_refused_with_those_that_exist():
    with pytest.raises(UnknownName, match=r"unknown joint 'a1'.*joint1"):
        Controller(six_axis(), Damping(joints=["a1"]))


# ---------------------------------------------------------------- what a solution says


def test_a_report_names_level_unit_error_and_residual():
    target = HOME + np.arange(N) * 0.01
    task = Posture(target, stiffness=4.0)
    solution = Controller(seven_axis(), JointLimits() >> task)(HOME, STILL)
    report = solution.report("posture")
    assert (report.name, report.level, report.unit) == ("posture", 2, "rad")
    np.testing.assert_allclose(report.error, HOME - target)
    np.testing.assert_allclose(report.residual, 0.0, atol=1e-9)
    assert report.active == ()


def test_a_report_gives_residuals_of_unweighted_rows():
    e = np.eye(1, N)
    levels = RawRows("one", e, [1.0]) + 3.0 * RawRows("two", e, [2.0])
    solution = resolve(seven_axis().state(HOME), levels)
    # min (1 - x)^2 + 9 (2 - x)^2: x = 1.9
    np.testing.assert_allclose(solution.acceleration[0], 1.9)
    np.testing.assert_allclose(solution.report("one").residual, -0.9)
    np.testing.assert_allclose(solution.report("two").residual, 0.1)


def test_a_report_names_the_joints_at_their_bounds():
    robot = seven_axis()
    target = HOME.copy()
    target[3] += 50.0
    solution = Controller(robot, JointLimits() >> Posture(target))(HOME, STILL)
    assert solution.report("joint limits").active == ("a4",)
    assert np.isnan(solution.report("joint limits").error).all()


def test_reports_come_from_the_top():
    solution = controller()(HOME, STILL)
    assert [r.name for r in solution.reports()] == [
        "torque limits", "joint limits", "posture",
    ]  # fmt: skip


def test_a_report_of_an_unknown_task_lists_those_that_exist():
    with pytest.raises(UnknownName, match=r"unknown task 'postur'.*'posture'"):
        controller()(HOME, STILL).report("postur")


def test_ranks_tell_a_lost_direction():
    row = np.eye(1, N)
    task = RawRows("twice", np.vstack([row, row]), [1.0, 1.0])
    solution = resolve(seven_axis().state(HOME), task >> Posture())
    assert solution.ranks == (1, N - 1)


@pytest.mark.parametrize("ask", ["certificate", "reports"])
def test_a_solution_of_an_earlier_tick_refuses_to_answer(ask):
    control = controller()
    old = control(HOME, STILL)
    control(HOME, STILL)
    with pytest.raises(StaleError, match="a later tick has rewritten"):
        getattr(old, ask)()


@pytest.mark.parametrize("ask", ["certificate", "reports"])
def test_a_fallback_has_nothing_to_prove(ask):
    solution = controller()(HOME * np.nan, STILL)
    with pytest.raises(StaleError, match="this tick fell back"):
        getattr(solution, ask)()


def test_a_fallback_reports_no_acceleration():
    solution = controller()(HOME * np.nan, STILL)
    assert np.isnan(solution.acceleration).all()
    assert solution.ranks == ()


def test_a_solution_stays_stale_after_a_fallback_follows_it():
    control = controller()
    old = control(HOME, STILL)
    torque = old.torque.copy()
    control(HOME * np.nan, STILL)
    np.testing.assert_array_equal(old.torque, torque)


def test_the_text_of_a_solution_says_how_it_ended():
    assert "SOLVED" in repr(controller()(HOME, STILL))
    assert "SENSOR_INVALID" in repr(controller()(HOME * np.nan, STILL))


def test_resolving_one_state_is_the_tick_of_a_controller():
    robot, hierarchy = seven_axis(), TorqueLimits() >> Posture(HOME + 0.1)
    tick = Controller(robot, hierarchy)(HOME, STILL + 0.1)
    once = resolve(robot.state(HOME, STILL + 0.1), hierarchy)
    np.testing.assert_array_equal(once.torque, tick.torque)


@pytest.mark.parametrize("duplicate", [copy.deepcopy, pickle.dumps])
def test_a_controller_cannot_be_copied_because_it_reads_memory_in_place(duplicate):
    robot = six_axis()
    control = Controller(robot, Posture())
    control(robot.q_home, np.zeros(robot.nv))
    with pytest.raises(InputError, match="make another one"):
        duplicate(control._stack)


def test_a_task_keeps_following_its_target_in_two_controllers_at_once():
    robot, posture = six_axis(), Posture()
    controls = [Controller(robot, posture) for _ in range(2)]
    still = np.zeros(robot.nv)
    before = [c(robot.q_home, still).acceleration for c in controls]
    posture.set_target(robot.q_home + 0.1)
    after = [c(robot.q_home, still).acceleration for c in controls]
    assert np.allclose(before, 0.0)
    assert np.allclose(after, 25.0 * 0.1)


def test_the_fallback_holds_the_posture_that_the_robot_was_in():
    robot = seven_axis()
    control, still = Controller(robot, Posture()), np.zeros(7)
    q = robot.q_home + 0.4
    control(q, still)
    gravity = robot.state(q).gravity()
    blind = control(np.full(7, np.nan), still)
    assert np.allclose(blind.torque, gravity)
    one_lost = np.where(np.arange(7) == 3, np.nan, q)
    assert np.allclose(control(one_lost, still).torque, gravity)


@pytest.mark.parametrize("where", ["error", "drift", "A"])
@pytest.mark.parametrize("resolver", [HierarchicalQP, NullSpace])
def test_a_task_that_writes_nan_is_named_and_the_robot_held(where, resolver):
    class Broken(MotionTask):
        def evaluate(self, state, out):
            getattr(out, where)[:] = np.nan

    robot = six_axis()
    broken = Broken("broken", "m", ("x",), Damper(1.0))
    if where == "error":
        broken = Broken("broken", "m", ("x",), PD(1.0))
    control = Controller(robot, broken >> Posture(), resolver())
    solution = control(robot.q_home, np.zeros(robot.nv))
    assert solution.status is Status.SOLVER_FAILED
    assert "'broken' wrote a row 'x'" in solution.message
    assert np.isfinite(solution.torque).all()


def test_one_posture_follows_each_robots_own_home():
    posture = Posture()
    for robot in (six_axis(), seven_axis(), six_axis()):
        control = Controller(robot, posture)
        q = robot.q_home + 0.1
        acceleration = control(q, np.zeros(robot.nv)).acceleration
        assert np.allclose(acceleration, -25.0 * 0.1)


def test_a_target_of_the_wrong_size_is_refused_and_the_old_one_stays():
    robot, posture = six_axis(), Posture()
    control = Controller(robot, posture)
    with pytest.raises(InputError, match="must be"):
        posture.set_target([0.0, 0.0, 0.0])
    posture.set_target(robot.q_home)
    still = np.zeros(robot.nv)
    assert np.allclose(control(robot.q_home, still).acceleration, 0.0)


@pytest.mark.parametrize("resolver", ["hqp", HierarchicalQP])
def test_what_is_no_resolver_is_refused(resolver):
    with pytest.raises(InputError, match="expected a resolver"):
        Controller(six_axis(), Posture(), resolver)


def test_a_wrench_of_the_wrong_shape_is_refused():
    robot = six_axis()
    control = Controller(robot, Posture())
    with pytest.raises(InputError, match="wrench 'wrist'"):
        control(robot.q_home, np.zeros(robot.nv), 0.0, {"wrist": [1.0, 2.0]})
