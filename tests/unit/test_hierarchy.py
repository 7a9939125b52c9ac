"""Operators that write a hierarchy down, and what they refuse."""

from __future__ import annotations

import numpy as np
import pytest

from tasks import Damping, JointLimits, Posture, TorqueLimits
from wbc import Hierarchy, InputError, Level


def names(hierarchy: Hierarchy) -> list[list[str]]:
    return [[task.name for task, _ in level.terms] for level in hierarchy.levels]


def weights(level: Level) -> list[float]:
    return [weight for _, weight in level.terms]


a, b, c, d = (Posture(name=name) for name in "abcd")


def test_plus_shares_a_level():
    assert names(Hierarchy.of(a + b)) == [["a", "b"]]


def test_shift_ranks_strictly():
    assert names(a >> b) == [["a"], ["b"]]


def test_a_number_weighs_a_task():
    assert weights(0.5 * a) == [0.5]


def test_an_integer_weighs_as_well():
    assert weights(2 * a) == [2.0]


def test_a_number_may_stand_on_either_side():
    assert weights(a * 2) == [2.0]
    assert weights((a + 2.0 * b) * 0.5) == [0.5, 1.0]


@pytest.mark.parametrize("weigh", [lambda h: 2 * h, lambda h: h * 2])
def test_a_hierarchy_has_no_weight(weigh):
    with pytest.raises(InputError, match="a weight belongs to a task or a level"):
        weigh(a >> b)


def test_a_number_weighs_every_task_of_a_sum():
    assert weights(0.5 * (a + 2.0 * b)) == [0.5, 1.0]


def test_plus_binds_tighter_than_shift():
    assert names(a + b >> c + d) == [["a", "b"], ["c", "d"]]


def test_a_weight_binds_tighter_than_plus_and_shift():
    hierarchy = a >> b + 0.1 * c
    assert names(hierarchy) == [["a"], ["b", "c"]]
    assert weights(hierarchy.levels[1]) == [1.0, 0.1]


def test_shift_chains_from_left_to_right():
    assert names(a >> b >> c) == [["a"], ["b"], ["c"]]


def test_shift_is_associative():
    assert names(a >> (b >> c)) == names((a >> b) >> c)


def test_plus_is_associative():
    assert names(Hierarchy.of(a + (b + c))) == names(Hierarchy.of((a + b) + c))


def test_the_line_of_the_design_reads_as_meant():
    limits = TorqueLimits() + JointLimits()
    hierarchy = limits >> a + b >> c >> 0.1 * d
    assert names(hierarchy) == [
        ["torque limits", "joint limits"], ["a", "b"], ["c"], ["d"],
    ]  # fmt: skip
    assert len(hierarchy) == 4


def test_operators_leave_their_operands_alone():
    level, hierarchy = a + b, a >> b
    level + c, 3.0 * level, hierarchy >> c
    assert weights(level) == [1.0, 1.0]
    assert names(hierarchy) == [["a"], ["b"]]


def test_tasks_come_from_the_top():
    assert [task.name for task in (a + b >> c).tasks()] == ["a", "b", "c"]


def test_the_text_shows_weights_and_order():
    assert repr(a + 0.5 * b >> c) == (
        "(Posture('a') + 0.5 * Posture('b')) >> (Posture('c'))"
    )


def test_a_level_is_named_by_its_tasks():
    assert (a + b).name == "a + b"


# -------------------------------------------------------------------------- refused


def test_an_empty_hierarchy_is_refused():
    with pytest.raises(InputError, match="empty hierarchy has nothing to control"):
        Hierarchy()


def test_an_empty_level_is_refused():
    with pytest.raises(InputError, match="a level needs at least one task"):
        Level(())


def test_a_task_that_stands_twice_is_refused():
    with pytest.raises(InputError, match="task 'a' stands twice"):
        a >> b >> a


def test_two_tasks_of_one_name_are_refused():
    with pytest.raises(InputError, match="task 'a' has a namesake"):
        a + Posture(name="a") >> b


@pytest.mark.parametrize("weight", [0.0, -1.0, np.nan, np.inf])
def test_a_weight_that_is_not_positive_and_finite_is_refused(weight):
    with pytest.raises(InputError, match="weight must be finite and greater than 0"):
        weight * a


def test_a_weight_that_is_no_number_is_refused():
    with pytest.raises(InputError, match="weight must be a number, got 'heavy'"):
        "heavy" * a


def test_plus_with_a_hierarchy_on_the_left_says_how_to_write_it():
    with pytest.raises(InputError, match=r"limits >> \(a \+ b\) >> c"):
        (a >> b) + c


def test_plus_with_a_hierarchy_on_the_right_says_how_to_write_it():
    with pytest.raises(InputError, match=r"reads \(a \+ b\) >> c"):
        a + (b >> c)


@pytest.mark.parametrize("other", [None, 3.0, "b", Damping])
def test_what_is_no_task_is_refused_by_plus(other):
    with pytest.raises(InputError, match="expected a task, got"):
        a + other


@pytest.mark.parametrize("other", [None, 3.0, "b", Damping])
def test_what_is_no_task_is_refused_by_shift(other):
    with pytest.raises(InputError, match="expected a task, got"):
        a >> other


def test_a_hierarchy_inside_a_level_is_refused():
    with pytest.raises(InputError, match="cannot join a hierarchy"):
        Hierarchy(a >> b, c)
