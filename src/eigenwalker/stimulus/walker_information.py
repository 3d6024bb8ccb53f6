"""Walkers that show structure only, or dynamics only (J35; Mather and Murdoch, 1994)."""

from __future__ import annotations

from typing import Literal

import numpy as np

from eigenwalker.core.walker import Walker
from eigenwalker.population.population import Population

Information = Literal["full", "structure", "dynamics"]


def with_information(
    population: Population, walker: int | np.ndarray, information: Information
) -> Walker:
    """Return a walker as one of the three stimuli of Troje (2002), experiment.

    ``"full"``: all its own. ``"structure"``: its own mean posture p0; eigenpostures, phases and
    frequency are the population's averages. ``"dynamics"``: its own eigenpostures, phases and
    frequency on the population's mean posture (the mean, A16, which is printed without 1/m). Sizes
    are divided out first, of eigenpostures too (eq. 12, A17), so that all are equally tall.

    Parameters
    ----------
    population : Population
        Whose averages stand in. Flagged walkers shape none.
    walker : int, or array of shape (feature,)
        Number of a walker of it, or any point of its feature space.
    information : {"full", "structure", "dynamics"}
        What the stimulus may tell.

    Returns
    -------
    Walker

    Examples
    --------
    >>> people = ew.load_population()
    >>> shown = with_information(people, 3, "structure")
    >>> bool(shown.frequency_hz == people.average[people.feature_names.index("frequency_hz")])
    True

    """
    alike = population.size_normalised()
    if isinstance(walker, int | np.integer):
        if not 0 <= walker < len(population):
            raise ValueError(
                f"The population has walkers 0 to {len(population) - 1}, not {walker}."
            )
        own = alike.X[walker]
    else:
        own = _normalised(population, np.asarray(walker, dtype=float))
    match information:
        case "full":
            return alike.walker(own)
        case "structure":
            return alike.walker(alike.hybrid(structure=own, dynamics=alike.average))
        case "dynamics":
            return alike.walker(alike.hybrid(structure=alike.average, dynamics=own))
    raise ValueError(
        f"information={information!r} is not known; choose 'full', 'structure' or 'dynamics'."
    )


def _normalised(population: Population, vector: np.ndarray) -> np.ndarray:
    """A point of the feature space with its size divided out of all postures (eq. 12)."""
    mean = population.average[population.layout.columns("structure")]
    posture = vector[population.layout.columns("structure")]
    size = posture @ mean / (mean @ mean)
    scaled = vector.copy()
    scaled[population.layout.columns("postures")] /= size
    return scaled
