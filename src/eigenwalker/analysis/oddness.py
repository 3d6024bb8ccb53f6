"""Whether a walk is far from all walks that are known."""

# scipy has no types:
# pyright: reportMissingTypeStubs=false, reportUnknownVariableType=false
from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
import pandas as pd
from scipy.special import stdtr

from eigenwalker.population.population import Population

FAR = 0.05
"""Share of ordinary walks that may be called far; 0.04 to 0.07 were, with 8, 16 or 40 known."""
_OF_NUMBERS, _OF_DISTANCES = 0.03, 0.005
"""What a single number (the frequency) and each distance may have of it: distances go together."""
EVERYTHING = "everything"
TOGETHER = "how features go together"
"""The distance from the space that the walkers known span, where only combinations are odd."""
_LEAST = 1e-9
"""Distance of a walk that is known, whose logarithm is still a number."""


@dataclass(frozen=True, eq=False)
class Oddness:
    """How far walks are from those known, and how far those are from each other.

    Parameters
    ----------
    known : array of shape (walker, feature)
    parts : mapping of str to columns
        Blocks of the features.
    distances : DataFrame of shape (walker, part)
        Of each walker known from those of other persons: ``everything``, the distance to the
        nearest of them; `TOGETHER`, to the space that they span; of each block, the distance from
        their mean. All as root mean squares of features in standard deviations.
    n_persons : int

    See Also
    --------
    trait_model : Says it of new walks.
    """

    known: np.ndarray
    parts: Mapping[str, slice | np.ndarray]
    distances: pd.DataFrame
    n_persons: int

    @classmethod
    def learnt(cls, population: Population, persons: np.ndarray | None = None) -> Oddness:
        """Return the oddness of walks by those of a population."""
        X, layout = population.X, population.layout
        parts = {name: layout.columns(name) for name in layout.blocks}
        who = np.arange(len(X)) if persons is None else persons
        rows = [_distances(vector[None], X[who != who[row]], parts) for row, vector in enumerate(X)]
        return cls(X, parts, pd.concat(rows, ignore_index=True), len(set(who)))

    def of(self, vectors: np.ndarray) -> pd.DataFrame:
        """Return whether walks are far from all that are known.

        Parameters
        ----------
        vectors : array of shape (walker, feature)

        Returns
        -------
        DataFrame
            ``distance`` to the nearest walker known, as the root mean square of features in
            standard deviations. ``typicality``: about the share of ordinary walks that are as odd,
            by the oddest of their parts: the distance from everything, from the space that all
            span, from the mean of each block, and each block of one number (the frequency).
            Numbers, and logarithms of distances, are compared with those of the walkers known, each
            left out, as one more of a normal distribution, by Student's t. ``far``: whether that is
            5 % at most; ``far_in``, the block that is oddest then.

        References
        ----------
        Ramaswamy, Rastogi & Shim (2000), SIGMOD: outliers by the distance to a neighbour. Hahn &
        Meeker (1991), Statistical Intervals, ch. 4: one more of a normal distribution.
        """
        new = _distances(vectors, self.known, self.parts)
        least = self._p_values(vectors, new)
        typicality = (FAR * least.min(axis=1)).clip(upper=1)
        far = (typicality <= FAR).to_numpy()
        return pd.DataFrame(
            {
                "distance": new[EVERYTHING],
                "typicality": typicality,
                "far": far,
                "far_in": np.where(far, least.idxmin(axis=1), ""),
            }
        )

    def _p_values(self, vectors: np.ndarray, new: pd.DataFrame) -> pd.DataFrame:
        """Return how likely each part is as odd, as a multiple of where it is called far."""
        found: dict[str, np.ndarray] = {}
        for part in map(str, new):
            columns = self.parts.get(part, slice(None))
            if part in self.parts and self.known[:, columns].shape[1] == 1:
                known, values = self.known[:, columns][:, 0], vectors[:, columns][:, 0]
                found[part] = 2 * self._beyond(known, values, both=True) / _OF_NUMBERS
            else:
                known, values = (
                    np.log(self.distances[part].to_numpy()),
                    np.log(new[part].to_numpy()),
                )
                found[part] = self._beyond(known, values) / _OF_DISTANCES
        return pd.DataFrame(found)

    def _beyond(self, known: np.ndarray, values: np.ndarray, *, both: bool = False) -> np.ndarray:
        """Return the probability that one more of those known is above each value, by Student's t.

        With `both`, that it is as far on the same side of their mean.
        """
        scale = max(float(known.std(ddof=1)), _LEAST) * np.sqrt(1 + 1 / self.n_persons)
        score = (values - known.mean()) / scale
        return stdtr(max(self.n_persons - 1, 1), -np.abs(score) if both else -score)


def _distances(
    vectors: np.ndarray, others: np.ndarray, parts: Mapping[str, slice | np.ndarray]
) -> pd.DataFrame:
    """Return how far walkers are from others, in everything and by part: (walker, part)."""
    spread = others.std(axis=0, ddof=1) if len(others) > 1 else np.zeros(others.shape[1])
    spread = np.where(spread > 1e-9, spread, np.inf)
    of_others, z = (others - others.mean(axis=0)) / spread, (vectors - others.mean(axis=0)) / spread
    nearest = [np.sqrt(((each - of_others) ** 2).mean(axis=1)).min() for each in z]
    _, sizes, axes = np.linalg.svd(of_others, full_matrices=False)
    axes = axes[sizes > _LEAST]
    outside = np.sqrt(((z - z @ axes.T @ axes) ** 2).mean(axis=1))
    outside = np.maximum(outside, 1e-6)  # what rounding leaves of walks inside
    of_parts = {name: np.sqrt((z[:, columns] ** 2).mean(axis=1)) for name, columns in parts.items()}
    return pd.DataFrame({EVERYTHING: nearest, TOGETHER: outside, **of_parts}).clip(lower=_LEAST)
