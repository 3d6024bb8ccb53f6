"""The step along a discriminant that exaggerates a trait."""

from __future__ import annotations

from typing import Literal, get_args

import numpy as np

from eigenwalker.analysis.discriminant import DiscriminantClassifier, DiscriminantRegressor
from eigenwalker.analysis.walker_space import WalkerSpace

Kind = Literal["discriminant", "mean_difference"]
Units = Literal["sd", "raw", "classmean"]
Discriminant = DiscriminantClassifier | DiscriminantRegressor


def direction(
    space: WalkerSpace,
    discriminant: Discriminant,
    *,
    kind: Kind = "discriminant",
    units: Units = "sd",
) -> np.ndarray:
    r"""Return the step that exaggerates a trait: ``w + alpha * step`` is the caricature.

    .. math:: w = w_0 + \alpha V c'

    It can be added to the average walker and to any other. It leads towards
    ``discriminant.positive_pole_``.

    Parameters
    ----------
    space : WalkerSpace
        Fitted on walkers.
    discriminant : DiscriminantClassifier or DiscriminantRegressor
        Fitted on their scores in that space.
    kind : {"discriminant", "mean_difference"}
        Along c itself, the filter that predicts best; or along cov(K) c, the pattern that varies
        with it. For two classes the latter is the difference of the class means within the
        components used, positive minus negative pole.
    units : {"sd", "raw", "classmean"}
        Length of the step. "sd": c k changes by its standard deviation over the walkers, so alpha
        is a z-score. "raw": V c' as printed, or V cov(K) c. "classmean": c k changes by half the
        distance between the two classes, so that their means are at +1 and -1.

    Returns
    -------
    array of shape (feature,)
        In units of the features.

    Raises
    ------
    ValueError
        If the discriminant was fitted on other columns than this space's scores; if it does not
        vary; if `units` is "classmean" and the trait a number.

    See Also
    --------
    trait_axis : The same for a trait of a population.

    References
    ----------
    Troje (2002), Decomposing biological motion, eq. 13. Troje (2002), The little difference, eq. 6.
    Moler (2016), The eigenwalker model of the human gait.

    Examples
    --------
    >>> walkers = np.array([[1.0, 5], [2, 4], [6, 4], [7, 5]])
    >>> space = WalkerSpace(scale=None).fit(walkers)
    >>> sex = ["female", "female", "male", "male"]
    >>> classifier = DiscriminantClassifier(n_components=1).fit(space.transform(walkers), sex)
    >>> step = direction(space, classifier, units="classmean")
    >>> (space.average_walker_ + step).round(6).tolist()
    [6.5, 4.5]
    """
    for name, choice, choices in (("kind", kind, Kind), ("units", units, Units)):
        if choice not in get_args(choices):
            raise ValueError(
                f"{name}={choice!r} is unknown; choose from {', '.join(get_args(choices))}."
            )
    c = discriminant.coef_
    if len(c) != len(space.eigenwalkers_):
        raise ValueError(
            f"The discriminant was fitted on {len(c)} columns, the space has "
            f"{len(space.eigenwalkers_)} eigenwalkers; fit it on space.transform(walkers)."
        )
    scores = c if kind == "discriminant" else discriminant.pattern_
    if units != "raw":
        advance = float(c @ scores)  # how much c k changes along the step
        if not advance > 0:
            raise ValueError(
                "The discriminant is the same for all walkers it was fitted on, so there is no "
                "direction to exaggerate; the trait may not vary with any component that was used."
            )
        scores = scores * _length(discriminant, units) / advance
    return scores @ space.eigenwalkers_


def _length(discriminant: Discriminant, units: Units) -> float:
    """How much c k changes in one step."""
    if units == "sd":
        return discriminant.spread_
    if not isinstance(discriminant, DiscriminantClassifier):
        raise ValueError(
            "units='classmean' is half the distance of two classes, and a continuous trait has "
            "none; use units='sd'."
        )
    first, second = discriminant.class_means_ @ discriminant.coef_
    return (second - first) / 2
