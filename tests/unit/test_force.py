"""Force tasks: memory, contact, and what they refuse."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal

from tasks import (
    Admittance,
    Damping,
    ForceLaw,
    HybridForceMotion,
    Impedance,
    JointLocking,
    Posture,
)
from tests.arms import seven_axis
from tests.tolerances import ROUND_OFF
from wbc import (
    PD,
    Controller,
    HierarchicalQP,
    InputError,
    NullSpace,
    SaturatedPD,
    Status,
    UnknownName,
    allocate_rows,
    resolve,
)

ARM = seven_axis()
TIP = "tip"
HOME = ARM.q_home
P = ARM.state(HOME).frame(TIP).p
REST = np.zeros(ARM.nv)
DOWN = np.array([0.0, 0.0, -1.0])
FLIPPED = np.diag([1.0, -1.0, -1.0])


def press(**options) -> HybridForceMotion:
    """A task that presses down with 20 N."""
    options = {"law": ForceLaw(0.0, 10.0), "sensor_frame": TIP, **options}
    return HybridForceMotion(TIP, P, [0.0, 0.0, 20.0], axes=FLIPPED, **options)


def felt(size: float) -> dict[str, np.ndarray]:
    return {"wrist": np.r_[size * DOWN, 0.0, 0.0, 0.0]}


def held(task: HybridForceMotion) -> float:
    """The integral term, from what it adds to the force that is asked for."""
    return float(task._held[0])


def test_the_integral_moves_once_a_tick_and_forgets_on_reset():
    task = press()
    controller = Controller(ARM, task >> Damping(), dt=1e-3)
    controller(HOME, REST, wrenches=felt(15.0))  # searching until the end of this tick
    before = held(task)
    for _ in range(3):
        controller(HOME, REST, wrenches=felt(15.0))
    assert_allclose(held(task) - before, 3 * 1e-3 * 10.0 * 5.0, rtol=1e-9)
    task.reset()
    assert held(task) == 0.0
    assert not task.touching


def test_the_integral_stops_at_its_limit():
    task = press(law=ForceLaw(0.0, 1e3, limit=7.0))
    controller = Controller(ARM, task >> Damping())
    for _ in range(50):
        solution = controller(HOME, REST, wrenches=felt(5.0))
    assert held(task) == 7.0
    for _ in range(3):  # and comes back at once: nothing was wound up
        controller(HOME, REST, wrenches=felt(25.0))
    assert held(task) < 0.0
    assert solution.ok


def test_what_is_not_finite_is_neither_sent_nor_remembered():
    task = press()
    controller = Controller(ARM, task >> Damping())
    for _ in range(3):
        controller(HOME, REST, wrenches=felt(15.0))
    before = held(task)
    solution = controller(HOME, REST, wrenches={"wrist": np.full(6, np.nan)})
    assert solution.status is Status.SENSOR_INVALID
    assert np.isfinite(solution.torque).all()
    assert held(task) == before
    law = ForceLaw(0.0, 10.0)
    kept = law.integrate(np.array([3.0]), np.array([np.nan]), 1e-3)
    assert_array_equal(kept, [3.0])


def test_a_sensor_that_falls_silent_makes_the_controller_hold_the_robot():
    task = press()
    controller = Controller(ARM, task >> Damping())
    controller(HOME, REST, wrenches=felt(15.0))
    before = held(task)
    solution = controller(HOME, REST)
    assert solution.status is Status.SOLVER_FAILED
    assert "fell silent" in solution.message
    assert np.isfinite(solution.torque).all()
    assert held(task) == before
    assert controller(HOME, REST, wrenches=felt(15.0)).ok


def test_contact_begins_at_the_threshold_and_ends_after_a_while_below_half_of_it():
    task = press(threshold=2.0)
    controller = Controller(ARM, task >> Damping())

    def feel(size: float, ticks: int = 1) -> bool:
        for _ in range(ticks):
            controller(HOME, REST, wrenches=felt(size))
        return task.touching

    assert not feel(1.9, 100)
    assert feel(2.0)
    assert feel(1.1, 200)
    assert feel(0.5, 40)
    assert not feel(0.5, 20)


def test_the_search_goes_along_the_force_at_its_speed_and_stops_at_it():
    task = press(approach=0.02, force_damping=40.0)
    row = allocate_rows(3, ARM.nv)
    task.update(ARM.state(HOME, wrenches=felt(0.0)), row)
    assert_allclose(row.lower[2] + row.drift[2], 40.0 * 0.02, rtol=1e-12)
    J = FLIPPED[:, 2] @ ARM.state(HOME).frame(TIP).J[:3]
    at_speed = ARM.state(HOME, 0.02 * np.linalg.pinv(J[None])[:, 0], wrenches=felt(0.0))
    task.update(at_speed, row)
    assert_allclose(row.lower[2] + row.drift[2], 0.0, atol=ROUND_OFF)


@pytest.mark.parametrize("resolver", [HierarchicalQP(), NullSpace()])
@pytest.mark.parametrize("kind", ["hybrid", "impedance", "admittance"])
def test_a_force_task_without_its_sensor_says_so_and_names_those_there_are(
    resolver, kind
):
    task = {
        "hybrid": lambda: press(),
        "impedance": lambda: Impedance(TIP, P, sensor_frame=TIP),
        "admittance": lambda: Admittance(TIP, P, sensor_frame=TIP),
    }[kind]()
    controller = Controller(ARM, task >> Damping(), resolver)
    with pytest.raises(InputError, match=r"force sensor 'wrist'.*told of: \(none\)"):
        controller(HOME, REST)
    with pytest.raises(InputError, match=r"needs force sensor 'wrist'.*of: ankle"):
        controller(HOME, REST, wrenches={"ankle": np.zeros(6)})
    with pytest.raises(UnknownName, match="wrist_sensor"):
        Controller(ARM, Impedance(TIP, P))


@pytest.mark.parametrize(
    ("make", "word"),
    [
        (lambda: press(selection=(0, 1)), "selection"),
        (lambda: press(selection=(0, 0, 2)), "selection"),
        (lambda: press(selection=(0, 0, 1, 0, 0, 0)), "orientation"),
        (lambda: press(force_damping=-1.0), "force_damping"),
        (lambda: press(approach=-0.1), "approach"),
        (lambda: press(threshold=0.0), "threshold"),
        (lambda: HybridForceMotion(TIP, P, [0.0, 20.0]), "force of"),
        (lambda: HybridForceMotion(TIP, P, [0, 0, np.nan]), "force of"),
        (lambda: HybridForceMotion(TIP, P, [0, 0, 1], axes=np.ones((3, 3))), "axes of"),
        (lambda: ForceLaw(1.0), "must be below 1"),
        (lambda: ForceLaw(-0.1), "proportional"),
        (lambda: ForceLaw(0.1, -1.0), "integral"),
        (lambda: ForceLaw(0.1, 1.0, 0.0), "limit"),
        (lambda: Impedance(TIP, P, mass=0.0), "mass of"),
        (lambda: Impedance(TIP, P, stiffness=[1.0, 2.0]), "stiffness of"),
        (lambda: Admittance(TIP, P, damping=-1.0), "damping of"),
        (lambda: Admittance(TIP, P, following=0.0), "following"),
        (lambda: SaturatedPD(100.0, 0.0, 1.0), "speed"),
        (lambda: JointLocking(0.0), "zone"),
        (lambda: Controller(ARM, JointLocking(3.0)), "leaves 'a1' no range"),
        (lambda: Controller(ARM, press(stiffness=[1.0, 2.0, 3.0])), "2 such rows"),
    ],
)
def test_what_cannot_be_used_is_refused_by_name(make, word):
    with pytest.raises(InputError, match=word):
        make()


def test_no_two_tasks_answer_the_same_measured_force():
    soft = Impedance(TIP, P, sensor_frame=TIP)
    with pytest.raises(InputError, match=r"'tip hybrid' and 'tip impedance' both"):
        press() >> soft
    assert len(press(sensor="ankle") >> soft >> Damping()) == 3
    moments = HybridForceMotion(
        TIP,
        P,
        np.zeros(6),
        (0, 0, 0, 1, 1, 0),
        orientation=np.eye(3),
        name="moments",
    )
    assert len(press() >> moments) == 2


def test_units_of_rows_that_move_and_rows_that_press():
    task = press(selection=(0, 0, 1))
    assert task.row_units(3) == ("m", "m", "N")
    assert task.wish_units(3) == ("m/s^2",) * 3
    six = HybridForceMotion(
        TIP, P, np.zeros(6), (1, 0, 0, 0, 1, 0), orientation=np.eye(3)
    )
    assert six.row_units(6) == ("N", "m", "m", "rad", "Nm", "rad")
    assert six.wish_units(6) == ("m/s^2",) * 3 + ("rad/s^2",) * 3


def test_a_refused_target_leaves_the_old_one():
    task = press()
    for change in (
        lambda: task.set_target([np.nan, 0.0, 0.0]),
        lambda: task.set_force([1.0]),
        lambda: task.set_axes(np.zeros((3, 3))),
    ):
        before = allocate_rows(3, ARM.nv), allocate_rows(3, ARM.nv)
        state = ARM.state(HOME, wrenches=felt(3.0))
        task.update(state, before[0])
        with pytest.raises(InputError):
            change()
        task.update(state, before[1])
        assert_array_equal(before[0].lower, before[1].lower)


# ------------------------------------------------------------- laws and joint locking


def test_a_saturated_pd_is_a_pd_up_close_and_bounded_and_straight_from_afar():
    law, near = SaturatedPD(400.0, 0.2, 3.0), 1e-3 * np.array([1.0, -2.0, 0.5])
    rate = np.array([0.01, 0.0, -0.02])
    assert_allclose(
        law.acceleration(near, rate), PD(400.0).acceleration(near, rate), rtol=1e-12
    )
    far = np.array([3.0, -4.0, 0.0])
    start = law.acceleration(far, np.zeros(3))
    assert_allclose(start, -3.0 * far / 5.0)
    assert_allclose(law.acceleration(far, -0.2 * far / 5.0), 0.0, atol=ROUND_OFF)


def test_a_saturated_pd_arrives_without_running_past():
    law, e, v = SaturatedPD(10000.0, 0.2, 1.0), np.array([0.15]), np.zeros(1)
    way = []
    for _ in range(3000):
        v = v + 1e-3 * law.acceleration(e, v)
        e = e + 1e-3 * v
        way.append([e[0], abs(v[0])])
    errors, speeds = np.array(way).T
    assert errors.min() > -1e-5
    assert speeds.max() < 0.2 + ROUND_OFF
    assert abs(errors[-1]) < 1e-9


def test_locking_holds_a_joint_in_its_zone_though_the_task_below_would_free_it():
    joint = ARM.joint_names[3]
    i = ARM.joint_index(joint)
    inside, outside = HOME.copy(), HOME.copy()
    inside[i] = ARM.q_max[i] - 0.05
    outside[i] = ARM.q_max[i] - 0.11
    away = Posture(HOME)
    for resolver in (NullSpace(), HierarchicalQP()):
        for q, is_held in ((inside, True), (outside, False)):
            stack = JointLocking(0.1) >> away
            vdot = resolve(ARM.state(q), stack, resolver).acceleration
            assert (abs(vdot[i]) < 1e-9) == is_held
