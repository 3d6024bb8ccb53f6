"""Whether a walk is far from all walks that are known."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
import pandas as pd

from eigenwalker.population.population import Population

FAR = 0.02
"""Share of ordinary walks that are called far, where enough are known; else 1 / (n + 1)."""
EVERYTHING = "everything"


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
        nearest of them; of each block, the distance from their mean. Both as root mean squares of
        features in standard deviations.

    See Also
    --------
    trait_model : Says it of new walks.
    """

    known: np.ndarray
    parts: Mapping[str, slice | np.ndarray]
    distances: pd.DataFrame

    @classmethod
    def learnt(cls, population: Population, persons: np.ndarray | None = None) -> Oddness:
        """Return the oddness of walks by those of a population."""
        X, layout = population.X, population.layout
        parts = {name: layout.columns(name) for name in layout.blocks}
        who = np.arange(len(X)) if persons is None else persons
        rows = [_distances(vector[None], X[who != who[row]], parts) for row, vector in enumerate(X)]
        return cls(X, parts, pd.concat(rows, ignore_index=True))

    def of(self, vectors: np.ndarray) -> pd.DataFrame:
        """Return whether walks are far from all that are known.

        Parameters
        ----------
        vectors : array of shape (walker, feature)

        Returns
        -------
        DataFrame
            ``distance`` to the nearest walker known, as the root mean square of features in
            standard deviations. ``typicality``: the share of walkers known, this one among them,
            that are as odd; oddness is the largest of the distances by everything and by each
            block, each above its median and relative to how far the 95th percentile of the known is
            above it. ``far``: whether that is 2 % at most, or as little as it can be; ``far_in``,
            the block that is oddest then.

        References
        ----------
        Ramaswamy, Rastogi & Shim (2000), SIGMOD: outliers by the distance to a neighbour. Laxhammar
        & Falkman (2014), IEEE Trans. PAMI 36:1158: a rank among those of the known as a test.
        """
        new = _distances(vectors, self.known, self.parts)
        odd, odd_known = self._relative(new), self._relative(self.distances).max(axis=1).to_numpy()
        as_odd = (odd_known >= odd.max(axis=1).to_numpy()[:, None]).sum(axis=1)
        n = len(odd_known)
        typicality = (1 + as_odd) / (1 + n)
        far = typicality <= max(FAR, 1 / (1 + n))
        return pd.DataFrame(
            {
                "distance": new[EVERYTHING],
                "typicality": typicality,
                "far": far,
                "far_in": np.where(far, odd.idxmax(axis=1), ""),
            }
        )

    def _relative(self, distances: pd.DataFrame) -> pd.DataFrame:
        median, high = self.distances.median(), self.distances.quantile(0.95)
        return (distances - median) / (high - median).clip(lower=1e-9)


def _distances(
    vectors: np.ndarray, others: np.ndarray, parts: Mapping[str, slice | np.ndarray]
) -> pd.DataFrame:
    """Return how far walkers are from others, in everything and by part: (walker, part)."""
    spread = others.std(axis=0, ddof=1) if len(others) > 1 else np.zeros(others.shape[1])
    spread = np.where(spread > 1e-9, spread, np.inf)
    nearest = [np.sqrt((((each - others) / spread) ** 2).mean(axis=1)).min() for each in vectors]
    z = (vectors - others.mean(axis=0)) / spread
    of_parts = {name: np.sqrt((z[:, columns] ** 2).mean(axis=1)) for name, columns in parts.items()}
    return pd.DataFrame({EVERYTHING: nearest, **of_parts})
