"""Words, keys and windows: what shows a run as it goes, without a screen."""

from __future__ import annotations

import contextlib

import mujoco
import numpy as np
import pytest

import tasks
from robots import racer
from sims import constraints
from sims.run import Decision
from sims.view import Display, WindowClosed
from sims.view import display as display_module
from sims.view.caption import Caption, caption
from sims.view.jogger import REACH, STEP, Jogger
from sims.view.marks import TARGET, ball
from sims.view.overlay import Frame
from sims.view.window import FRAME, LONGEST, NoWindow, Restart, Window
from tests.arms import six_axis
from wbc import Controller, HierarchicalQP, InputError

TIP = "torch_tip"
SPACE, BACKSPACE = 32, 259
KEY_UP, KEY_PAGE_DOWN = 265, 267


# ------------------------------------------------------------------------------ words


def decided(stack, q=None) -> Decision:
    robot = six_axis()
    controller = Controller(robot, stack, HierarchicalQP())
    q = robot.q_home if q is None else q
    solution = controller(q, np.zeros(6))
    return Decision(controller, None, solution)


def test_words_tell_time_levels_errors_and_bounds():
    robot = six_axis()
    p = robot.state(robot.q_home).frame(TIP).p
    goal = tasks.FramePosition(TIP, p + np.array([0.0, 0.003, 0.004]), name="goal µ")
    far = tasks.Posture(robot.q_home + 3.0, stiffness=1e5, name="far")
    stack = tasks.TorqueLimits() >> goal >> far
    words = caption("a run", 1.25, [decided(stack)])
    left, right = words.left.splitlines(), words.right.splitlines()
    assert left == ["a run", "1 torque limits", "2 goal ?", "3 far"]
    assert right[0] == "1.25 s"
    assert right[1].startswith("at bound: joint")
    assert right[2] == "5.00 mm"
    assert right[3] == f"{3e3 * np.sqrt(6.0):.0f} mrad"


def test_words_name_the_robots_where_there_are_several():
    decision = decided(tasks.TorqueLimits() >> tasks.Damping())
    words = caption("two", 0.0, [decision, decision])
    assert words.left.splitlines().count("racer") == 2
    assert len(words.left.splitlines()) == len(words.right.split("\n")) == 7


def test_words_tell_a_fallback():
    q = np.full(6, np.nan)
    words = caption("run", 0.0, [decided(tasks.Damping(), q)])
    assert words.right.splitlines()[1] == "a measurement is not finite"


# ------------------------------------------------------------------------------- keys


def follow(jogger, task, script, t):
    """Targets over the times t, by one key press at the beginning."""
    rows = []
    for now in t:
        script(now)
        rows.append(task.parameters(six_axis()).copy())
        if now == t[0]:
            jogger.press(KEY_UP)
            jogger.press(KEY_PAGE_DOWN)
    return np.array(rows)


def check_derivatives(p, t):
    """Columns 3-6 are the rate of columns 0-3, columns 6-9 the rate of those."""
    dt = t[1] - t[0]
    for k in (0, 3):
        slope = (p[2:, k : k + 3] - p[:-2, k : k + 3]) / (2.0 * dt)
        np.testing.assert_allclose(slope, p[1:-1, k + 3 : k + 6], atol=4e-3)


def test_keys_move_a_target_smoothly_on_top_of_what_its_script_wants():
    v = np.array([0.1, 0.0, 0.0])
    goal = tasks.FramePosition(TIP, np.zeros(3))
    jogger = Jogger()
    script = jogger.over(
        tasks.Damping() >> goal, six_axis(), lambda t: goal.set_target(t * v, v), 2.0
    )
    t = 2.0 + np.arange(0.0, 3.0, 1e-3)
    targets = follow(jogger, goal, script, t)
    np.testing.assert_allclose(targets[0, :3], 2.0 * v, atol=1e-12)
    check_derivatives(targets[1:], t[1:])
    step = STEP * REACH * np.array([1.0, 0.0, -1.0])
    np.testing.assert_allclose(targets[-1, :3], t[-1] * v + step, atol=1e-6)


def test_keys_turn_an_orientation_and_stay_where_they_brought_it():
    task = tasks.FrameOrientation(TIP, np.eye(3))
    jogger = Jogger()
    script = jogger.over(tasks.Damping() >> task, six_axis(), None, 0.0)
    targets = follow(jogger, task, script, np.arange(0.0, 3.0, 1e-3))
    R = targets[-1, :9].reshape(3, 3)
    angle = np.arccos(0.5 * (np.trace(R) - 1.0))
    assert angle == pytest.approx(np.sqrt(2.0) * STEP, rel=1e-4)
    np.testing.assert_allclose(targets[-1, 9:], 0.0, atol=1e-5)


def test_keys_leave_the_orientation_of_a_pose_and_its_twist():
    twist = np.arange(1.0, 7.0)
    pose = tasks.FramePose(TIP, np.ones(3), np.eye(3))
    pose.set_target(np.ones(3), np.eye(3), twist, -twist)
    before = pose.parameters(six_axis()).copy()
    jogger = Jogger()
    jogger.over(tasks.Damping() >> pose, six_axis(), None, 0.0)(0.0)
    np.testing.assert_allclose(pose.parameters(six_axis()), before, atol=1e-12)


def test_keys_do_nothing_to_a_stack_without_a_pose():
    script = print
    stack = tasks.TorqueLimits() >> tasks.Damping()
    assert Jogger().over(stack, six_axis(), script, 0.0) is script


# ---------------------------------------------------------------------------- display


class FakeWindow:
    """A window whose operator wants the run again at its third picture."""

    def __init__(self, world, jogger, camera):
        self.world, self.shown, self.wishes = world, [], 1

    def due(self):
        return True

    def show(self, frame):
        self.shown.append(self.world.data.time)
        if len(self.shown) == 3 and self.wishes:
            self.wishes = 0
            raise Restart

    def close(self):
        pass


def test_a_restart_repeats_the_job_from_the_state_that_it_began_in(monkeypatch):
    monkeypatch.setattr(display_module, "Window", FakeWindow)
    monkeypatch.setattr(display_module, "need_display", lambda: None)
    arm = racer.load("probe")
    cell = constraints.cell(arm)
    for _ in range(5):
        cell.step()
    began, starts = cell.data.time, []
    controller = Controller(arm, tasks.TorqueLimits() >> tasks.Damping())

    def job():
        starts.append((cell.data.time, cell.data.qpos.copy()))
        for _ in range(4):
            seen = cell.observe()
            solution = controller(seen.q, seen.v)
            cell.apply(solution.torque)
            cell.step()
            display(cell, [Decision(controller, seen, solution)])
        return "done"

    with Display(view=True) as display:
        display.attach(cell)
        assert display.play("job", job) == "done"
        shown = display._window.shown
    assert [t for t, _ in starts] == [began, began]
    np.testing.assert_array_equal(starts[0][1], starts[1][1])
    np.testing.assert_allclose(np.array(shown[3:]) - began, [1e-3, 2e-3, 3e-3, 4e-3])


def test_a_display_of_nothing_lets_every_run_go_on():
    with Display() as display:
        display.attach(constraints.cell(racer.load("probe")))
        assert display.jogger is None
        assert display.play("job", lambda: display(None, [])) is True


def test_a_restart_that_nobody_plays_ends_the_run(monkeypatch):
    monkeypatch.setattr(display_module, "Window", FakeWindow)
    monkeypatch.setattr(display_module, "need_display", lambda: None)
    with Display(view=True) as display:
        display.attach(constraints.cell(racer.load("probe")))
        assert [display(None, []) for _ in range(3)] == [True, True, False]


def test_where_no_window_opens_it_says_so_and_goes_on(monkeypatch, capsys):
    def fails(*given):
        raise NoWindow("no screen at all")

    monkeypatch.setattr(display_module, "Window", fails)
    monkeypatch.setattr(display_module, "need_display", lambda: None)
    with Display(view=True) as display:
        display.attach(constraints.cell(racer.load("probe")))
        assert display.jogger is None
        assert display(None, []) is True
    assert "no screen at all); running headless" in capsys.readouterr().err


def test_a_video_elsewhere_than_in_an_mp4_is_refused(tmp_path):
    with pytest.raises(InputError, match=r"must end in \.mp4"):
        Display(video=str(tmp_path / "film.gif"))


# ----------------------------------------------------------------------------- window


class World:
    """The least that a window can show."""

    def __init__(self):
        self.model = mujoco.MjModel.from_xml_string("<mujoco><worldbody/></mujoco>")
        self.data, self.wrists = mujoco.MjData(self.model), ()


class Handle:
    """MuJoCo's viewer as far as a window uses it; `at` does something at a sync."""

    def __init__(self, world):
        self.user_scn = mujoco.MjvScene(world.model, maxgeom=10)
        self.cam = mujoco.MjvCamera()
        self.running, self.syncs, self.texts, self.at = True, 0, [], {}

    def lock(self):
        return contextlib.nullcontext()

    def set_texts(self, text):
        self.texts.append(text[2:])

    def sync(self):
        self.syncs += 1
        self.at.get(self.syncs, lambda: None)()

    def is_running(self):
        return self.running

    def close(self):
        self.running = False


@pytest.fixture
def opened(monkeypatch):
    """World, viewer and window."""
    world = World()
    handle = Handle(world)
    monkeypatch.setattr(Window, "_launch", lambda self, world: handle)
    return world, handle, Window(world, Jogger())


PICTURE = Frame([ball(np.ones(3), TARGET)], Caption("a run", "1.00 s"))


def test_a_window_gets_marks_and_words(opened):
    _, handle, window = opened
    assert window.due()
    window.show(PICTURE)
    window.show(PICTURE)
    assert handle.user_scn.ngeom == 1
    np.testing.assert_allclose(handle.user_scn.geoms[0].pos, 1.0)
    assert handle.texts == [("a run", "1.00 s")]
    assert handle.syncs == 2


def test_a_picture_is_due_every_sixtieth_of_a_second_and_after_a_clock_set_back(opened):
    world, _, window = opened
    world.data.time = 1.0
    window.show(PICTURE)
    assert not window.due()
    world.data.time = 1.0 + 0.5 * FRAME
    assert not window.due()
    world.data.time = 1.0 + LONGEST
    assert window.due()
    world.data.time = 0.0
    assert window.due()


def test_space_holds_the_run_until_it_comes_again(opened):
    _, handle, window = opened
    handle.at[4] = lambda: window._key(SPACE)
    window._key(SPACE)
    window.show(PICTURE)
    assert handle.syncs == 4
    assert handle.texts[0] == ("paused\na run", "\n1.00 s")
    window.show(PICTURE)
    assert handle.syncs == 5
    assert handle.texts[-1] == ("a run", "1.00 s")


@pytest.mark.parametrize("paused", [False, True])
def test_backspace_restarts_the_run_and_lets_it_go(opened, paused):
    _, handle, window = opened
    if paused:
        window._key(SPACE)
    handle.at[1] = lambda: window._key(BACKSPACE)
    with pytest.raises(Restart):
        window.show(PICTURE)
    window.show(PICTURE)
    assert handle.syncs == 2


def test_the_viewers_own_reset_counts_as_a_restart(opened):
    """It wipes the state at the next sync."""
    world, handle, window = opened
    world.data.time = 1.0
    handle.at[1] = lambda: mujoco.mj_resetData(world.model, world.data)
    with pytest.raises(Restart):
        window.show(PICTURE)


@pytest.mark.parametrize("paused", [False, True])
def test_a_closed_window_ends_the_run(opened, paused):
    _, handle, window = opened
    if paused:
        window._key(SPACE)
    handle.at[2 if paused else 1] = window.close
    with pytest.raises(WindowClosed):
        window.show(PICTURE)


def test_other_keys_go_to_the_jogger(monkeypatch):
    world, jogger = World(), Jogger()
    monkeypatch.setattr(Window, "_launch", lambda self, world: Handle(world))
    window = Window(world, jogger)
    goal = tasks.FramePosition(TIP, np.zeros(3))
    script = jogger.over(tasks.Damping() >> goal, six_axis(), None, 0.0)
    window._key(KEY_UP)
    for t in np.arange(0.0, 3.0, 1e-3):
        script(t)
    x = goal.parameters(six_axis())[0]
    assert x == pytest.approx(STEP * REACH, rel=1e-4)
