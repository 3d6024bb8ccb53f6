"""People who do not exist, as varied as those of a population."""

from __future__ import annotations

import numpy as np

from eigenwalker.core.arguments import generator
from eigenwalker.population.population import Population


def draw_people(population: Population, n_people: int, *, random_state: int) -> np.ndarray:
    """Return features of people drawn from the distribution of a population: (people, feature).

    Normal, with the average and the covariance of its walkers, those with a flag left out. The same
    random state gives the same people.
    """
    rows = population.without_flags().X
    deviations = (rows - rows.mean(axis=0)) / np.sqrt(max(len(rows) - 1, 1))
    draws = generator(random_state).standard_normal((n_people, len(rows)))
    return population.average + draws @ deviations
