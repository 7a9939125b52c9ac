"""The compiled lexicographic solver, on problems of every bad kind."""

from __future__ import annotations

import numpy as np
import pytest

from tests.tolerances import PROOF
from wbc.certificate import certify
from wbc.lexicographic import Lexicographic

PROBLEMS = 2500  # for each of four scales
KINDS = (
    "plain", "redundant", "conflict", "zero", "rank one", "free", "nearly singular",
    "uneven rows",
)  # fmt: skip
NEARLY = (1e-6, 1e-3)
"""Singular values next to 1 of a level that is nearly singular."""

Levels = list[tuple[np.ndarray, np.ndarray, np.ndarray]]


def level(rng: np.random.Generator, n: int, above: Levels) -> tuple:
    """Rows of a random kind, each an equality or with bounds on one or both sides."""
    m, kind = int(rng.integers(1, 5)), rng.choice(KINDS)
    A = rng.normal(size=(m, n))
    if kind == "redundant":
        A[-1] = -2.0 * A[0]
    elif kind == "conflict" and above:
        A[0] = above[int(rng.integers(len(above)))][0][0]
    elif kind == "zero":
        A[0] = 0.0
    elif kind == "rank one":
        A = rng.normal(size=(m, 1)) * rng.normal(size=n)
    elif kind == "nearly singular":
        U, sigma, Vt = np.linalg.svd(A, full_matrices=False)
        sigma[-1] = sigma[0] * 10.0 ** rng.uniform(*np.log10(NEARLY))
        A = (U * sigma) @ Vt
    elif kind == "uneven rows":
        A *= 10.0 ** rng.uniform(-2.0, 2.0, (m, 1))
    b = 3.0 * rng.normal(size=m)
    sides = rng.choice(["equal", "both", "lower", "upper"], m)
    lower = np.where(sides == "upper", -np.inf, b)
    upper = np.where(sides == "lower", np.inf, b + rng.exponential(1.0, m))
    upper = np.where(sides == "equal", b, upper)
    if kind == "free":
        lower[0], upper[0] = -np.inf, np.inf
    return A, lower, upper


def problem(seed: int, scale: float = 0.0) -> Levels:
    """One to six levels, half of them under a box; each times 10^(+-scale)."""
    rng = np.random.default_rng(seed)
    n = int(rng.integers(1, 15))
    levels: Levels = []
    if rng.random() < 0.5:
        levels.append((np.eye(n), -np.ones(n), np.ones(n)))
    for _ in range(int(rng.integers(1, 6))):
        levels.append(level(rng, n, levels))
    factors = 10.0 ** rng.uniform(-scale, scale, len(levels))
    return [
        (f * A, f * low, f * high)
        for f, (A, low, high) in zip(factors, levels, strict=True)
    ]


def stacked(levels: Levels) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    A, lower, upper = (np.concatenate(part) for part in zip(*levels, strict=True))
    return np.ascontiguousarray(A), lower, upper


def solver_for(levels: Levels) -> Lexicographic:
    return Lexicographic([low.size for _, low, _ in levels], levels[0][0].shape[1])


def proof(levels: Levels, x: np.ndarray) -> float:
    """Worst residual in scaled units: levels of unit norm, x of unit norm if larger."""
    sizes = [np.linalg.norm(A) or 1.0 for A, _, _ in levels]
    length = max(1.0, float(np.linalg.norm(x)))
    scaled = [
        (A / f, low / (f * length), high / (f * length))
        for f, (A, low, high) in zip(sizes, levels, strict=True)
    ]
    return certify(scaled, x / length).worst


@pytest.mark.parametrize("scale", [0.0, 1.0, 3.0, 6.0])
def test_every_solution_proves_itself(scale):
    worst = (0.0, -1)
    for seed in range(PROBLEMS):
        levels = problem(seed, scale)
        solver = solver_for(levels)
        assert solver.solve(*stacked(levels)), f"seed {seed} was not solved"
        worst = max(worst, (proof(levels, solver.x.copy()), seed))
    assert worst[0] <= PROOF, f"seed {worst[1]}: {worst[0]:.1e}"


def test_a_warm_start_from_any_set_reaches_the_same_optimum():
    for seed in range(200):
        levels = problem(seed)
        warm, cold = solver_for(levels), solver_for(levels)
        rng = np.random.default_rng(seed)
        for _ in range(5):
            moved = [
                (A + 0.1 * rng.normal(size=A.shape), low, high)
                for A, low, high in levels
            ]
            arrays = stacked(moved)
            cold.reset()
            assert warm.solve(*arrays)
            assert cold.solve(*arrays)
            np.testing.assert_allclose(warm.x, cold.x, atol=1e-7, rtol=1e-7)


def test_the_same_problem_gives_the_same_bits():
    for seed in range(50):
        levels = problem(seed)
        first, second = solver_for(levels), solver_for(levels)
        first.solve(*stacked(levels))
        second.solve(*stacked(levels))
        assert np.array_equal(first.x, second.x)


def test_a_level_without_rows_changes_nothing():
    A, b = np.array([[1.0, 2.0]]), np.array([3.0])
    solver = Lexicographic([0, 1, 0], 2)
    assert solver.solve(A, b, b)
    np.testing.assert_allclose(solver.x, [0.6, 1.2])


def test_a_row_of_zeros_keeps_its_slack():
    solver = Lexicographic([1, 1], 1)
    A, b = np.array([[0.0], [1.0]]), np.array([1.0, 2.0])
    assert solver.solve(A, b, b)
    np.testing.assert_allclose(solver.x, [2.0])
    np.testing.assert_allclose(solver.slack, [1.0, 0.0])


def test_too_few_iterations_are_admitted():
    levels = problem(1)
    sizes, n = [low.size for _, low, _ in levels], levels[0][0].shape[1]
    solver = Lexicographic(sizes, n, most=1)
    assert not solver.solve(*stacked(levels))
    assert np.isfinite(solver.x).all()
