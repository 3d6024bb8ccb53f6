"""Numbers of a model with as many decimals as the page needs to agree with Python."""

from __future__ import annotations

import numpy as np

from eigenwalker.population.features import FeatureLayout

DECIMALS = 7
"""Of millimetres: what a walker is made of adds up to within a millionth."""
FINER = 3
"""More decimals for hertz and radians, which limbs of hundreds of mm multiply."""


def rounded(values: np.ndarray, decimals: int = DECIMALS) -> list:
    """Return numbers as lists of numbers with so many decimals, and 0 for -0.

    Examples
    --------
    >>> rounded(np.array([[1.23456789, -1e-9]]))
    [[1.2345679, 0.0]]

    """
    return (np.round(values, decimals) + 0.0).tolist()


def rounded_vectors(
    vectors: np.ndarray, layout: FeatureLayout, columns: np.ndarray | None = None, finer: int = 0
) -> list:
    """Return vectors of features, timing with more decimals than postures.

    Parameters
    ----------
    vectors : array of shape (..., feature)
    layout : FeatureLayout
        What each feature is.
    columns : array of int, optional
        The features that there are, where not all.
    finer : int
        More decimals for all, for vectors that are multiplied before they are added.

    """
    timing = np.isin(np.arange(len(layout)), layout.columns("timing"))
    timing = timing if columns is None else timing[columns]
    posture = np.round(vectors, DECIMALS + finer)
    fine = np.round(vectors, DECIMALS + FINER + finer)
    return (np.where(timing, fine, posture) + 0.0).tolist()


def significant(value: float, figures: int = 12) -> float:
    """Return a number with so many figures.

    Examples
    --------
    >>> significant(1 / 3, 3)
    0.333

    """
    return float(f"{value:.{figures}g}")
