"""Fit of the perceptual metric: 210 pairs of 21 walkers, a constant and eight weights.

Non-negative least squares at once, beside what the paper did: gradient descent from 1000 random
starts (L-BFGS-B, and SLSQP from fewer of them). The optimum is the same one.
"""

from __future__ import annotations

import itertools

import numpy as np
from scipy.optimize import minimize
from scipy.spatial.distance import pdist
from side_by_side import machine, print_table, seconds

from eigenwalker.psychophysics.cross_validation import goodness
from eigenwalker.psychophysics.perceptual_metric import PerceptualMetric, non_negative_fit
from eigenwalker.psychophysics.reliability import bootstrap_weights
from eigenwalker.psychophysics.shape_search import fit_from_random_starts, search_shape

N_WALKERS, N_STARTS, N_SLSQP = 21, 1000, 50
PAIRS = list(itertools.combinations(range(N_WALKERS), 2))


def study(seed: int) -> tuple[np.ndarray, np.ndarray]:
    """Distances of eight groups in mm, and differences of which four groups count."""
    rng = np.random.default_rng(seed)
    X = np.column_stack([pdist(rng.normal(scale=20, size=(N_WALKERS, 3))) for _ in range(8)])
    signal = X @ [0.0, 0, 0.36, 0.43, 0, 0, 0.02, 0.19]
    return X, np.clip(signal / signal.mean() * 0.8 + rng.normal(scale=0.1, size=len(signal)), 0, 1)


def slsqp(X: np.ndarray, y: np.ndarray, n_starts: int) -> float:
    """Least sum of squared errors that SLSQP finds from so many starts."""
    size = np.linalg.norm(X, axis=0)
    design = np.column_stack([np.ones(len(y)), X / size])

    def error(c_and_w: np.ndarray) -> tuple[float, np.ndarray]:
        residual = design @ c_and_w - y
        return float(residual @ residual), 2 * design.T @ residual

    rng = np.random.default_rng(0)
    limits = [(None, None), *[(0, None)] * X.shape[1]]
    ends = [
        minimize(error, rng.uniform(size=design.shape[1]), jac=True, bounds=limits, method="SLSQP")
        for _ in range(n_starts)
    ]
    return min(end.fun for end in ends)


def standardised_starts(X: np.ndarray, y: np.ndarray, n_starts: int) -> float:
    """Least sum of squared errors of L-BFGS-B from random starts, columns of unit spread."""
    middle, spread = X.mean(axis=0), X.std(axis=0)
    design = np.column_stack([np.ones(len(y)), (X - middle) / spread])

    def error(c_and_w: np.ndarray) -> tuple[float, np.ndarray]:
        residual = design @ c_and_w - y
        return float(residual @ residual), 2 * design.T @ residual

    rng = np.random.default_rng(0)
    limits = [(None, None), *[(0, None)] * X.shape[1]]
    starts = rng.uniform(size=(n_starts, design.shape[1]))
    return min(
        minimize(error, start, jac=True, bounds=limits, method="L-BFGS-B").fun for start in starts
    )


def compare_fits(seed: int) -> None:
    X, y = study(seed)
    starts = fit_from_random_starts(X, y, n_starts=N_STARTS)
    ours = goodness(y, PerceptualMetric().fit(X, y).predict(X))["rss"]
    assert ours <= starts.rss.min() + 1e-12, (ours, starts.rss.min())
    near = np.mean(starts.rss <= ours * (1 + 1e-6))
    times = seconds(
        {
            f"{N_STARTS} random starts, L-BFGS-B": lambda: standardised_starts(X, y, N_STARTS),
            "PerceptualMetric().fit": lambda: PerceptualMetric().fit(X, y),
            "non_negative_fit": lambda: non_negative_fit(X, y),
        },
        rounds=3,
    )
    print_table(
        f"Fit {seed}", times, aims={"non_negative_fit": 5000, "PerceptualMetric().fit": 100}
    )
    print(f"  objective {ours:.15f}; best start {starts.rss.min() - ours:+.1e}")
    print(f"  starts within 1e-6 of it: {near:.1%}")
    best = slsqp(X, y, N_SLSQP)
    print(f"  best of {N_SLSQP} starts of SLSQP {best - ours:+.1e}")


def compare_shapes() -> None:
    d, y = study(0)
    counts = np.full((29, len(y)), 2.0)
    times = seconds(
        {
            "power of F: grid and Brent about exact fits": lambda: search_shape(
                lambda n: d**n, y, bounds=(0.05, 3)
            ),
            "1000 bootstrap samples": lambda: bootstrap_weights(
                d, counts * 0.5, counts, pairs=PAIRS
            ),
        },
        rounds=3,
    )
    print_table("What exact fits make quick", times, aims={})


if __name__ == "__main__":
    print(f"Perceptual metric ({machine()})")
    for seed in range(3):
        compare_fits(seed)
    compare_shapes()
