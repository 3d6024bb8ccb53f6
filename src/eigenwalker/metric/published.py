"""Published metrics: the nine rows of Pražák et al. (2010, fig. 5), Lee et al. and Kovar et al.

Only the weights of a row are used, relative to each other. They sum to 1 up to rounding (one row to
1.027, a misprint). The columns "constant" and "normalisation constant" could only be used with the
units of d, which the paper does not name, and a rule for how the second is applied; no single
reading fits all nine rows. So these metrics compare: which of two pairs of walks differs more, and
where. They do not predict shares of observers. For that, fit `PerceptualMetric` to the answers of
your own observers, or refit the constant and one factor to them.

The sigmoid d / (d + 1) needs a unit most of all. Here d is in metres, metres a second and radians.
It is then nearly linear for the differences between walks, which are a tenth of that, as it must
have been in the paper, whose weights are nearly the same for d / (d + 1) and for d. Where a capture
lacks a group, its weight falls to the others.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import NamedTuple

from eigenwalker.core.arguments import check_choice
from eigenwalker.metric.frame_metrics import GroupMetric, Metric, Shape
from eigenwalker.metric.joint_groups import GROUPS, By


class PublishedFit(NamedTuple):
    """A row of figure 5: difference from the observers, both constants, weights of `GROUPS`.

    See Also
    --------
    PUBLISHED : Metrics with such weights.

    References
    ----------
    Pražák et al. (2010), fig. 5.
    """

    difference: float
    constant: float
    normalisation: float
    weights: tuple[float, ...]


_FIGURE_5 = """
angles squared         23.335 0.508  659.272 0.000 0.000 0.006 0.000 0     0.669 0.325 0
angles absolute        18.448 0.324   19.537 0.041 0.003 0.061 0.000 0     0.622 0.273 0
angles sigmoid         18.004 0.312   20.016 0.039 0.008 0.076 0.000 0     0.614 0.263 0
positions squared      17.117 0.290  206.509 0.062 0.000 0.551 0.181 0.000 0.000 0.050 0.156
positions absolute     13.423 0.069    9.909 0.020 0.000 0.362 0.429 0.000 0.000 0.000 0.189
positions sigmoid      13.264 0.059   10.375 0.015 0.000 0.344 0.455 0.000 0.000 0.000 0.184
velocities squared     25.779 0.431 1914.283 0.000 0.000 0.000 0.000 0.605 0.000 0.298 0.098
velocities absolute    22.039 0.193   36.885 0.000 0.000 0.000 0.000 0.551 0.000 0.298 0.151
velocities sigmoid     21.993 0.189   36.532 0.000 0.000 0.000 0.000 0.564 0.000 0.306 0.157
"""


FIGURE_5: Mapping[tuple[By, Shape], PublishedFit] = {
    (by, shape): PublishedFit(*map(float, row[:3]), tuple(map(float, row[3:])))  # pyright: ignore[reportAssignmentType, reportCallIssue] - words of the table above
    for by, shape, *row in map(str.split, _FIGURE_5.strip().splitlines())
}
"""The nine rows as printed, weights in the order of `GROUPS`; angles have no hand and no toe. (The
text says that velocities use hands, thighs and calves; the table says hands, calves and toes, and
is followed.)"""

LEE = GroupMetric(
    "lee", "angles", "squared", dict.fromkeys(("upper_arm", "forearm", "thigh", "calf"), 1.0)
)
"""The angles of Lee et al. (2002): squared rotations of shoulders, elbows, hips and knees with
equal weights, none for neck, wrists, ankles and toes. Their pelvis and spine belong to no group of
figure 5 and are left out, as are their terms of velocity and of the root. (The choice of joints is
that reported by later papers; theirs was not at hand.)"""

KOVAR = GroupMetric("kovar", "positions", "squared", dict.fromkeys(GROUPS, 1.0))
"""After Kovar, Gleicher and Pighin (2002): squared distances of points. Theirs are points on the
skin with equal weights, aligned in a window; here all joint groups have equal weights, so that the
head counts as much as both elbows together."""

PUBLISHED: Mapping[str, GroupMetric] = {
    **{
        f"{by}-{shape}": GroupMetric(
            f"{by}-{shape}", by, shape, dict(zip(GROUPS, row.weights, strict=True))
        )
        for (by, shape), row in FIGURE_5.items()
    },
    "lee": LEE,
    "kovar": KOVAR,
}
"""Metrics by name: ``"positions-sigmoid"`` and the other eight of figure 5, ``"lee"``, ``"kovar"``.
The weights that Wang and Bodenheimer (2003) found for Lee's metric are missing, as their table was
not at hand."""


def metric_named(metric: str | Metric) -> Metric:
    """Return a published metric by its name; any other metric unchanged."""
    if not isinstance(metric, str):
        return metric
    check_choice(metric, PUBLISHED, "metric")
    return PUBLISHED[metric]
