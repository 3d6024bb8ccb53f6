"""Jack-knife curves: all numbers of components of a classifier, every walker left out in turn.

Beside the way one would write it down: delete the walker, standardise, SVD, least squares, order,
cumulate.
"""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np
from side_by_side import machine, print_table, seconds

from eigenwalker.analysis import jackknife_curves
from eigenwalker.analysis._leave_out import LeaveOutSVD

N_FEATURES = 229


def population(n_walkers: int) -> tuple[np.ndarray, np.ndarray]:
    rng = np.random.default_rng(n_walkers)
    r = np.where(np.arange(n_walkers) % 2, 1.0, -1.0)
    mixing = np.eye(N_FEATURES) + 0.02 * rng.normal(size=(N_FEATURES, N_FEATURES))
    walkers = rng.normal(size=(n_walkers, N_FEATURES)) @ mixing
    return walkers + 0.2 * r[:, None] * rng.normal(size=N_FEATURES), r


def naive_fold(X: np.ndarray, r: np.ndarray, walker: int) -> np.ndarray:
    kept, r_kept = np.delete(X, walker, axis=0), np.delete(r, walker)
    mean, u = kept.mean(axis=0), kept.std(axis=0, ddof=1)
    standardised = (kept - mean) / u
    _, _, axes = np.linalg.svd(standardised, full_matrices=False)
    axes = axes[: len(kept) - 1]
    K = standardised @ axes.T
    c = np.linalg.lstsq(K, r_kept, rcond=None)[0]
    ranked = np.argsort(-np.abs(c) * K.std(axis=0))
    k = ((X[walker] - mean) / u) @ axes.T
    return np.cumsum((c * k)[ranked])


def our_folds(table: LeaveOutSVD, walkers: Iterable[int]) -> list[np.ndarray]:
    folds = table.leaving_out([np.array([walker]) for walker in walkers])
    return [fold.sums("standardised")[:, 0] for _, fold in folds]


def ready(n_walkers: int) -> tuple[np.ndarray, np.ndarray, LeaveOutSVD]:
    X, r = population(n_walkers)
    return X, r, LeaveOutSVD.of(X, r[:, None], scale="sd", scale_in_fold=True)


def compare_whole_curves(n_walkers: int, aim: float) -> None:
    X, r = population(n_walkers)
    naive = [naive_fold(X, r, walker) for walker in range(n_walkers)]
    np.testing.assert_allclose(jackknife_curves(X, r).held_out, naive, atol=1e-8)
    times = seconds(
        {
            "naive": lambda: [naive_fold(X, r, walker) for walker in range(n_walkers)],
            "jackknife_curves": lambda: jackknife_curves(X, r),
        },
        rounds=25,
    )
    title = f"Curves of {n_walkers} walkers, {N_FEATURES} features"
    print_table(title, times, aims={"jackknife_curves": aim})


def compare_folds(n_walkers: int, aim: float | None = None) -> None:
    X, r, table = ready(n_walkers)
    sample = range(0, n_walkers, n_walkers // 10)
    np.testing.assert_allclose(
        our_folds(table, sample), [naive_fold(X, r, walker) for walker in sample], atol=1e-8
    )
    times = seconds(
        {
            "naive": lambda: [naive_fold(X, r, walker) for walker in sample],
            "ours": lambda: our_folds(table, sample),
        },
        rounds=7,
    )
    per_fold = {name: taken / len(sample) for name, taken in times.items()}
    title = f"One fold of {n_walkers} walkers, {N_FEATURES} features"
    print_table(title, per_fold, aims={} if aim is None else {"ours": aim})


def compare_growth(few: int, many: int) -> None:
    tables = {n: ready(n)[2] for n in (few, many)}
    times = seconds(
        {str(n): lambda table=table: our_folds(table, range(10)) for n, table in tables.items()},
        rounds=15,
    )
    growth = many * times[str(many)] / (few * times[str(few)])
    print(f"\nWhole curves of {many} walkers take {growth:.2f} times those of {few}")
    print(f"  linear growth would be {many / few:.2f}, as a fold costs the same")


if __name__ == "__main__":
    print(f"Jack-knife ({machine()})")
    compare_whole_curves(40, aim=3)
    compare_folds(200)
    compare_folds(1000, aim=8)
    compare_growth(1000, 2000)
