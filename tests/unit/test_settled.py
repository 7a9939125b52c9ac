"""Attributes of tasks: what would have no effect is refused, what has one is taken."""

from __future__ import annotations

import numpy as np
import pytest

import tasks
from tests.arms import seven_axis
from tests.catalogue import CATALOGUE, random_state
from wbc import PD, Controller, InputError, MotionTask, Rows, State
from wbc.settled import Settled

ARM = seven_axis()
FREE = {
    "law": PD(7.0),
    "speed": 0.3,
    "fraction": 0.5,
    "rate": 10.0,
}


def made(kind):
    rng = np.random.default_rng(0)
    return CATALOGUE[kind].make(random_state(ARM, rng), rng, False).task


def free(task) -> set[str]:
    found = {n: getattr(type(task), n) for n in dir(type(task))}
    return {n for n, p in found.items() if isinstance(p, property) and p.fset}


@pytest.mark.parametrize("kind", CATALOGUE, ids=lambda kind: kind.__name__)
def test_an_attribute_that_nobody_would_read_is_refused(kind):
    task = made(kind)
    public = {n for n in dir(task) if n[0] != "_"} - free(task)
    for name in (*public, "targt", "stiffnes"):
        kept = getattr(task, name, None)
        with pytest.raises(InputError, match=rf"'{name}' of task .* Controller.change"):
            setattr(task, name, 5)
        now = getattr(task, name, None)
        assert now is kept or repr(now) == repr(kept)


@pytest.mark.parametrize("kind", CATALOGUE, ids=lambda kind: kind.__name__)
def test_an_attribute_with_a_setter_is_taken_and_offered(kind):
    task = made(kind)
    for name in free(task):
        setattr(task, name, FREE[name])
        assert np.all(getattr(task, name) == FREE[name])
        with pytest.raises(InputError, match=rf"change at any time: .*{name}"):
            task.targt = 5


def test_methods_that_move_the_target_are_offered():
    with pytest.raises(InputError, match=r"any time: set_target\(\), law\."):
        tasks.Posture().stiffness = 5


class Push(MotionTask):
    """A user's task, with a state that its methods change."""

    def __init__(self) -> None:
        super().__init__("push", "rad", ("x",), PD(1.0))
        self.wanted, self.ticks = 0.0, 0

    def evaluate(self, state: State, out: Rows) -> None:
        self.ticks += 1
        self.last = state.t
        out.error[0] = state.q[0] - self.wanted
        out.J[0, 0] = 1.0


class Strict(Settled, Push):
    """The same with the manners of the library."""

    def __init__(self) -> None:
        super().__init__()
        self._seen = 0

    def evaluate(self, state: State, out: Rows) -> None:
        self._seen += 1


def test_a_task_in_plain_python_keeps_its_own_state():
    task = Push()
    controller = Controller(ARM, task)
    first = controller(ARM.q_home, 0 * ARM.q_home).torque
    task.wanted, task.anything = 1.0, 2
    assert not np.allclose(controller(ARM.q_home, 0 * ARM.q_home).torque, first)
    assert task.ticks == 2


def test_a_task_of_ones_own_may_have_the_same_manners():
    task = Strict()
    Controller(ARM, task)(ARM.q_home, 0 * ARM.q_home)
    assert task._seen == 1
    with pytest.raises(InputError, match="'wanted' of task 'push'"):
        task.wanted = 1.0
    task.law = PD(2.0)
