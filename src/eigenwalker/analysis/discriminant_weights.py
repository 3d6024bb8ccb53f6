"""The weights of ``c K = r``, in numbers: what the discriminants and `trait_axis` fit."""

from __future__ import annotations

from typing import Literal, NamedTuple, get_args

import numpy as np

from eigenwalker.core.arguments import check_choice

Order = Literal["standardised", "raw", "variance"]


class Weights(NamedTuple):
    """A solution, with the meanings of the attributes of `DiscriminantClassifier`."""

    c: np.ndarray
    intercept: float
    order: np.ndarray
    spread: float
    pattern: np.ndarray


def discriminant_weights(
    K: np.ndarray,
    r: np.ndarray,
    *,
    centred: bool,
    n_components: int | None = None,
    order: Order = "standardised",
) -> Weights:
    """Solve ``c K = r`` by least squares and use the components that contribute most."""
    middle = K.mean(axis=0) if centred else np.zeros(K.shape[1])
    level = r.mean() if centred else 0.0
    solution = np.linalg.lstsq(K - middle, r - level, rcond=None)[0]
    by_contribution = order_of_components(solution, K.std(axis=0, ddof=1), order)
    used = by_contribution[:n_components]
    c, pattern = np.zeros_like(solution), np.zeros_like(solution)
    c[used] = solution[used]
    projections = K @ c
    pattern[used] = K[:, used].T @ (projections - projections.mean()) / (len(K) - 1)
    spread = float(projections.std(ddof=1))
    return Weights(c, float(level - middle @ c), by_contribution, spread, pattern)


def order_of_components(c: np.ndarray, spread: np.ndarray, order: Order) -> np.ndarray:
    """Return components from the highest contribution to the discriminant to the lowest.

    Weights c have the shape (component, ...); the standard deviations of the scores, `spread`,
    broadcast against it. Contributions within 1e-12 of the highest are ties, and keep their order.
    """
    check_choice(order, get_args(Order), "order")
    contribution: np.ndarray = {
        "standardised": np.abs(c) * spread,
        "raw": np.abs(c),
        "variance": np.broadcast_to(spread, c.shape),
    }[order]
    highest: np.ndarray = contribution.max(axis=0, initial=np.finfo(float).tiny)
    return np.argsort(-np.round(contribution / highest, 12), axis=0, kind="stable")
