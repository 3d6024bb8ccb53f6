"""The step along a discriminant that exaggerates a trait."""

from __future__ import annotations

from typing import TYPE_CHECKING, Literal, get_args

import numpy as np

from eigenwalker.core.arguments import check_choice, described

if TYPE_CHECKING:
    from eigenwalker.analysis.discriminant import DiscriminantClassifier, DiscriminantRegressor
    from eigenwalker.analysis.walker_space import WalkerSpace

Kind = Literal["discriminant", "mean_difference"]
Units = Literal["sd", "raw", "classmean"]


def direction(
    space: WalkerSpace,
    discriminant: DiscriminantClassifier | DiscriminantRegressor,
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
    >>> space = ew.analysis.WalkerSpace(scale=None).fit(walkers)
    >>> sex = ["female", "female", "male", "male"]
    >>> classifier = ew.analysis.DiscriminantClassifier(n_components=1).fit(
    ...     space.transform(walkers), sex
    ... )
    >>> step = direction(space, classifier, units="classmean")
    >>> (space.average_walker_ + step).round(6).tolist()
    [6.5, 4.5]
    """
    for given, attribute, expected in (
        (space, "eigenwalkers_", "a fitted WalkerSpace"),
        (discriminant, "coef_", "a fitted DiscriminantClassifier or DiscriminantRegressor"),
    ):
        if not hasattr(given, attribute):
            raise TypeError(f"Expected {expected}, got {described(given)}.")
    c = discriminant.coef_
    if len(c) != len(space.eigenwalkers_):
        raise ValueError(
            f"The discriminant was fitted on {len(c)} columns, the space has "
            f"{len(space.eigenwalkers_)} eigenwalkers; fit it on space.transform(walkers)."
        )
    scores = step_in_scores(
        c, discriminant.pattern_, discriminant.spread_, getattr(discriminant, "class_means_", None),
        kind=kind, units=units,
    )  # fmt: skip
    return scores @ space.eigenwalkers_


def step_in_scores(
    c: np.ndarray,
    pattern: np.ndarray,
    spread: float,
    class_means: np.ndarray | None,
    *,
    kind: Kind,
    units: Units,
) -> np.ndarray:
    """Return the step of `direction` along the eigenwalkers: shape (component,)."""
    for name, choice, choices in (("kind", kind, Kind), ("units", units, Units)):
        check_choice(choice, get_args(choices), name)
    scores = c if kind == "discriminant" else pattern
    if units == "raw":
        return scores
    advance = float(c @ scores)  # how much c k changes along the step
    if not advance > 0:
        raise ValueError(
            "The discriminant is the same for all walkers it was fitted on, so there is no "
            "direction to exaggerate; the trait may not vary with any component that was used."
        )
    length = spread if units == "sd" else _half_distance(c, class_means)
    return scores * length / advance


def _half_distance(c: np.ndarray, class_means: np.ndarray | None) -> float:
    """How much c k changes from the middle between two classes to either."""
    if class_means is None:
        raise ValueError(
            "units='classmean' is half the distance of two classes, and a continuous trait has "
            "none; use units='sd'."
        )
    first, second = class_means @ c
    return (second - first) / 2
