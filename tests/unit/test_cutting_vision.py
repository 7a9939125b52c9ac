"""Vision primitives of the cutting cell, each against a closed form or differences."""

from __future__ import annotations

import math

import numpy as np
import pinocchio as pin
import pytest
from numpy.testing import assert_allclose
from scipy.integrate import quad

from sims.cutting.camera import Camera, Frame
from sims.cutting.correction import SLOW, Correction
from sims.cutting.guide import GuideSurface
from sims.cutting.live import LiveGuide, Sight
from sims.cutting.polynomial import Polynomial
from sims.cutting.stroke import R_INIT, Stroke, heading, knife_target
from sims.cutting.timelaw import Clock, Motion, Quintic
from tests.tolerances import DIFFERENCE, ROUND_OFF, SAME, STEP
from wbc import InputError, UnknownName

PARABOLA = Polynomial([0.15, -0.4, 2.5], centre=0.33)
CUBIC = Polynomial([0.15, 0.3, -1.5, 9.0], centre=0.33)
CURVES = pytest.mark.parametrize("curve", [PARABOLA, CUBIC], ids=["2", "3"])


# ------------------------------------------------------------------- the polynomial


def test_a_fit_of_the_true_order_gives_the_polynomial_back():
    x = np.linspace(0.2, 0.5, 30)
    for curve, order in ((PARABOLA, 2), (CUBIC, 3), (CUBIC, 5)):
        fitted = Polynomial.fit(x, curve(x), order)
        assert_allclose(fitted(x), curve(x), atol=ROUND_OFF)


@CURVES
def test_derivatives_agree_with_differences(curve):
    for x in (0.21, 0.33, 0.47):
        before, at, after = (curve.at(x + d) for d in (-STEP, 0.0, STEP))
        for k in range(3):
            slope = (after[k] - before[k]) / (2.0 * STEP)
            assert at[k + 1] == pytest.approx(slope, abs=DIFFERENCE)
        assert at.y == pytest.approx(float(curve(x)), abs=ROUND_OFF)


@pytest.mark.parametrize("bend", [0.0, 1e-6, 1e-3, 0.4, -3.0, 40.0])
@pytest.mark.parametrize("slope", [-2.0, 0.0, 0.5])
def test_arc_length_is_the_integral_of_corrected_equation_8(bend, slope):
    curve = Polynomial([0.1, slope, bend], centre=0.3)
    wanted, _ = quad(
        lambda x: math.sqrt(1.0 + curve.at(x).y1 ** 2), 0.2, 0.5, epsabs=1e-13
    )
    assert curve.length(0.2, 0.5) == pytest.approx(wanted, rel=1e-10)
    assert curve.length(0.5, 0.2) == pytest.approx(-wanted, rel=1e-10)


def test_arc_length_of_a_cubic_is_the_integral_too():
    wanted, _ = quad(
        lambda x: math.sqrt(1.0 + CUBIC.at(x).y1 ** 2), 0.2, 0.5, epsabs=1e-13
    )
    assert CUBIC.length(0.2, 0.5) == pytest.approx(wanted, rel=1e-10)


def test_a_fit_says_what_it_needs():
    with pytest.raises(InputError, match="needs 3 points at different x, got 2"):
        Polynomial.fit([0.1, 0.2, 0.2], [0.0, 0.1, 0.1])
    with pytest.raises(InputError, match="coefficients of a guide line"):
        Polynomial([0.0, np.nan])


# --------------------------------------------------------------------- the time law


def test_the_quintic_goes_from_rest_to_rest_with_the_known_peaks():
    law = Quintic(0.3, 4.0)
    assert law.at(-1.0) == (0.0, 0.0, 0.0)
    assert law.at(0.0) == (0.0, 0.0, 0.0)
    assert law.at(9.0) == pytest.approx((0.3, 0.0, 0.0), abs=ROUND_OFF)
    samples = [law.at(t) for t in np.linspace(0.0, 4.0, 2001)]
    assert max(m.rate for m in samples) == pytest.approx(1.875 * 0.3 / 4.0)
    peak = 10.0 / math.sqrt(3.0) * 0.3 / 16.0
    assert max(m.acceleration for m in samples) == pytest.approx(peak, rel=1e-5)


def test_the_quintic_has_the_derivatives_that_it_says():
    law = Quintic(-0.2, 3.0)
    _agree(law.at, (0.4, 1.5, 2.7))


def test_a_clock_stops_and_goes_on_without_a_jolt():
    clock, law = Clock(), Quintic(0.3, 4.0)
    dt, motions, wanted = 1e-4, [], []
    for tick in range(60_000):
        go = 0.0 if 1.0 < tick * dt < 2.5 else 1.0
        clock.tick(dt, go)
        wanted.append(go)
        motions.append(clock.slowed(law.at(clock.time)))
    s, sd, sdd = np.array(motions).T
    assert_allclose(np.diff(s) / dt, sd[1:], atol=1e-4)
    assert_allclose(np.diff(sd) / dt, sdd[1:], atol=5e-3)
    still = slice(20_000, 25_000)
    assert np.ptp(s[still]) < 1e-4
    assert s[-1] == pytest.approx(0.3, abs=1e-9)


# ------------------------------------------------------------------------ the stroke


@CURVES
@pytest.mark.parametrize("ends", [(0.2, 0.48), (0.46, 0.21)])
def test_a_stroke_travels_the_arc_length_that_the_time_law_says(curve, ends):
    stroke = Stroke(curve, *ends, 5.0)
    for t in np.linspace(0.0, 5.0, 23):
        x = stroke.at(t).value
        assert curve.length(ends[0], x) == pytest.approx(
            stroke.law.at(t).value, abs=ROUND_OFF
        )
    assert stroke.at(5.0).value == pytest.approx(ends[1], abs=1e-10)


@CURVES
def test_motion_along_x_and_heading_have_the_derivatives_that_they_say(curve):
    stroke = Stroke(curve, 0.2, 0.48, 5.0)
    _agree(stroke.at, (0.7, 2.5, 4.1))
    _agree(lambda t: heading(curve, stroke.at(t)), (0.7, 2.5, 4.1))


@CURVES
def test_the_blade_points_along_the_line_and_down(curve):
    stroke = Stroke(curve, 0.2, 0.48, 5.0)
    for t in (0.0, 1.3, 4.0):
        x = stroke.at(t)
        R = knife_target(curve, x, 0.31).R
        slope = curve.at(x.value).y1
        along = np.array([1.0, slope, 0.0]) / math.hypot(1.0, slope)
        assert_allclose(R[:, 0], -along, atol=ROUND_OFF)
        assert_allclose(R[:, 2], [0.0, 0.0, -1.0], atol=ROUND_OFF)
        theta = math.atan(slope)
        Rz = np.array(pin.exp3(np.array([0.0, 0.0, -theta])))
        assert_allclose(R, R_INIT @ Rz, atol=ROUND_OFF)


@CURVES
def test_the_knife_target_moves_with_the_twist_that_it_says(curve):
    stroke = Stroke(curve, 0.2, 0.48, 5.0)

    def at(t: float):
        side = Motion(0.01 * math.sin(t), 0.01 * math.cos(t), -0.01 * math.sin(t))
        return knife_target(curve, stroke.at(t), 0.31, side)

    for t in (0.9, 2.2, 3.8):
        before, now, after = at(t - STEP), at(t), at(t + STEP)
        turn = np.array(pin.log3(after.R @ before.R.T)) / (2.0 * STEP)
        moved = (after.p - before.p) / (2.0 * STEP)
        assert_allclose(now.V, np.concatenate([moved, turn]), atol=DIFFERENCE)
        assert_allclose(now.A, (after.V - before.V) / (2.0 * STEP), atol=DIFFERENCE)


def test_a_stroke_without_length_is_refused():
    with pytest.raises(InputError, match="has no length"):
        Stroke(PARABOLA, 0.3, 0.3, 4.0)


def _agree(motion, times) -> None:
    for t in times:
        before, now, after = motion(t - STEP), motion(t), motion(t + STEP)
        for k in range(2):
            slope = (after[k] - before[k]) / (2.0 * STEP)
            assert now[k + 1] == pytest.approx(slope, abs=DIFFERENCE)


# ---------------------------------------------------------------- the guide surface


def seam(x, z):
    return 0.15 + 0.02 * np.sin(8.0 * (x - 0.2)) + 0.2 * (z - 0.31)


def interface(noise: float = 0.0, seed: int = 0) -> np.ndarray:
    x, z = np.meshgrid(np.linspace(0.2, 0.48, 33), np.linspace(0.275, 0.355, 9))
    points = np.column_stack([x.ravel(), seam(x, z).ravel(), z.ravel()])
    return points + np.random.default_rng(seed).normal(0.0, noise, points.shape)


X = np.linspace(0.2, 0.48, 40)
SIDE = np.array([0.0, 1.0, 0.0])


def test_a_surface_of_a_plane_is_that_plane_everywhere():
    points = interface()
    points[:, 1] = 0.1 + 0.3 * points[:, 0] - 0.2 * points[:, 2]
    surface = GuideSurface(points)
    for z in (0.25, 0.27, 0.31, 0.40):
        assert_allclose(surface.line(X, z), 0.1 + 0.3 * X - 0.2 * z, atol=SAME)


@pytest.mark.parametrize("z", [0.27, 0.29, 0.313, 0.35])
def test_the_guide_line_at_any_depth_is_the_seam(z):
    assert_allclose(GuideSurface(interface()).line(X, z), seam(X, z), atol=3e-4)


def test_smoothing_leaves_less_error_than_the_noise():
    noise = 1e-3
    surface = GuideSurface(interface(noise), noise)
    error = surface.line(X, 0.31) - seam(X, 0.31)
    assert np.sqrt(np.mean(error**2)) < 0.5 * noise


def test_a_surface_says_what_is_wrong_with_its_points():
    with pytest.raises(InputError, match="at least 6 points of the interface, 5"):
        GuideSurface(interface()[:5])
    with pytest.raises(InputError, match="lie on one line"):
        GuideSurface(interface()[:33])
    with pytest.raises(InputError, match="finite"):
        GuideSurface(interface() * np.nan)
    with pytest.raises(InputError, match="coincide"):
        GuideSurface(np.vstack([interface(), interface()[:1]]))


# ------------------------------------------------------------------------ the camera


def test_a_camera_takes_frames_at_its_rate_and_delivers_them_late():
    camera = Camera(rate=50.0, delay=0.03)
    seen = [camera.look(k * 1e-3, interface) for k in range(200)]
    assert seen[29] is None
    assert seen[30].t == 0.0
    stamps = sorted({frame.t for frame in seen[30:]})
    assert_allclose(np.diff(stamps), 0.02, atol=1e-9)
    assert all(
        k * 1e-3 - frame.t >= 0.03 - 1e-9 for k, frame in enumerate(seen) if frame
    )


def test_points_are_only_asked_for_when_a_picture_is_taken():
    camera, asked = Camera(rate=50.0), []
    for k in range(100):
        camera.look(k * 1e-3, lambda: asked.append(1) or interface())
    assert len(asked) == 5


def test_noise_and_losses_are_those_that_were_asked_for_and_repeat():
    truth = interface()
    frames = [
        Camera(noise=1e-3, dropped=0.3, seed=7).look(0.0, lambda: truth)
        for _ in range(2)
    ]
    assert np.array_equal(frames[0].points, frames[1].points)
    assert 0.55 < len(frames[0].points) / len(truth) < 0.85
    only_noise = Camera(noise=1e-3, seed=7).look(0.0, lambda: truth).points
    assert np.std(only_noise - truth) == pytest.approx(1e-3, rel=0.1)


def test_a_blind_camera_repeats_its_last_frame():
    camera = Camera(rate=100.0, blind=[(0.05, 0.10)])
    stamps = [camera.look(k * 1e-3, interface).t for k in range(150)]
    assert stamps[99] == pytest.approx(0.04)
    assert stamps[105] == pytest.approx(0.10)


@pytest.mark.parametrize(
    "options",
    [
        {"rate": 0.0},
        {"delay": -1.0},
        {"noise": np.nan},
        {"dropped": 1.0},
        {"blind": [(2.0, 1.0)]},
    ],
)
def test_a_camera_refuses_options_without_sense(options):
    with pytest.raises(InputError):
        Camera(**options)


# ----------------------------------------------------- the live line and the update


def test_the_live_line_follows_a_moving_seam_between_frames():
    live, camera, speed = LiveGuide(), Camera(rate=50.0, delay=0.02), 0.01
    late = []
    for k in range(1500):
        t = k * 1e-3
        frame = camera.look(t, lambda t=t: interface() + speed * t * SIDE)
        if frame is not None:
            live.see(frame, 0.33, 0.31)
        sight = live.at(0.33, t)
        if t > 1.0:
            late.append(sight.y - seam(0.33, 0.31) - speed * t)
    assert np.abs(late).max() < 2e-5
    assert sight.rate == pytest.approx(speed, rel=1e-3)
    assert sight.slope == pytest.approx(0.16 * math.cos(8.0 * 0.13), abs=5e-3)


def test_a_live_line_that_grows_old_holds_still():
    live = LiveGuide()
    for k in range(5):
        points = interface() + 1e-4 * k * SIDE
        live.see(Frame(0.02 * k, points), 0.33, 0.31)
    assert live.age(1.08) == pytest.approx(1.0)
    soon, later = live.at(0.33, 1.0), live.at(0.33, 2.0)
    assert soon == later
    assert soon.rate == 0.0


def test_a_frame_with_too_few_points_is_no_frame():
    live = LiveGuide()
    live.see(Frame(0.0, interface()), 0.33, 0.31)
    live.see(Frame(0.5, interface()[:4]), 0.33, 0.31)
    assert live.age(0.5) == pytest.approx(0.5)
    assert LiveGuide().at(0.33, 0.0) is None


PLANNED, SEEN = 0.150, 0.160


@pytest.mark.parametrize(
    ("experiment", "settles"),
    [("initial", PLANNED), ("local", SEEN), ("printed", 0.5 * (PLANNED + SEEN))],
)
def test_where_the_update_settles(experiment, settles):
    """Equation (19) as printed feeds y_c into its own reference: it stops half-way."""
    update, knife = Correction(experiment), PLANNED
    for _ in range(2000):
        seen = Sight(SEEN, 0.0, 0.0)
        delta = update.tick(1e-3, seen, Motion(PLANNED, 0.0, 0.0), knife, 0.0)
        knife = PLANNED + delta.value
    assert knife == pytest.approx(settles, abs=1e-6)


def test_the_update_follows_a_moving_line_with_the_lag_of_what_is_not_fed_forward():
    update, quickness = Correction("local", 50.0), 50.0
    for k in range(2000):
        seen = Sight(SEEN + 0.02 * k * 1e-3, 0.2, 0.01)
        planned = Motion(PLANNED + 0.2 * 0.05 * k * 1e-3, 0.2 * 0.05, 0.0)
        delta = update.tick(1e-3, seen, planned, 0.0, 0.05)
    lag = 0.01 * SLOW / (0.05 + SLOW) * 2.0 / quickness
    assert delta.value == pytest.approx(seen.y - planned.value - lag, abs=1.1e-5)


def test_a_line_that_the_knife_drags_along_is_not_chased():
    """The seam follows the knife and creeps back within 0.2 s: it must not run away."""
    update, rest, line, knife = Correction("local"), SEEN, SEEN, PLANNED
    for _ in range(4000):
        seen = Sight(line, 0.0, 0.0)
        before = knife
        delta = update.tick(1e-3, seen, Motion(PLANNED, 0.0, 0.0), knife, 0.005)
        knife = PLANNED + delta.value
        line += (knife - before) - 1e-3 / 0.2 * (line - rest)
    assert knife == pytest.approx(rest, abs=1e-5)


@pytest.mark.parametrize(("experiment", "share"), [("local", 1.0), ("printed", 0.5)])
def test_an_update_can_begin_where_it_would_settle(experiment, share):
    assert Correction(experiment).restart(0.004) == pytest.approx(0.004 * share)
    assert Correction("initial").restart(0.004) == 0.0


def test_an_update_that_sees_nothing_holds():
    update = Correction("local")
    for k in range(3000):
        seen = Sight(SEEN, 0.0, 0.0) if k < 1500 else None
        delta = update.tick(1e-3, seen, Motion(PLANNED, 0.0, 0.0), 0.0, 0.0)
    assert delta.value == pytest.approx(SEEN - PLANNED, abs=1e-6)
    assert delta.rate == pytest.approx(0.0, abs=1e-9)


def test_experiments_have_names():
    with pytest.raises(UnknownName, match="Valid names: local, initial, printed"):
        Correction("global")
