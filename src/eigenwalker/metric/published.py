"""Published metrics, ready to use: the nine rows of Pražák et al. (2010, fig. 5), and Lee's (2002).

What is known of their scale is little. The weights of a row sum to 1 up to rounding (one of them to
1.027: a misprint), so they tell how the groups compare. The columns "constant" and "normalisation
constant" tell more only together with the units of d, which the paper does not name, and with what
it divides or multiplies by the second; no single reading fits all nine rows (A28). So these metrics
are for comparing: which of two pairs of walks differs more, and where. They give no share of
observers. For that, fit one's own observers' answers with `PerceptualMetric`, or refit the constant
and one factor to them.

The sigmoid d / (d + 1) needs a unit most of all. Here d is in metres, metres a second and radians:
then it bends gently for the differences between walks, which are a tenth of that, as it must have
for the paper, whose weights are nearly the same for d / (d + 1) and for d. Where a capture lacks a
group, its weight falls to the others (A37).
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import NamedTuple

import numpy as np

from eigenwalker.metric.frame_metrics import By, ComparesFrames, FrameMetric, Shape
from eigenwalker.metric.groups import GROUPS, group_points


@dataclass(frozen=True)
class GroupMetric:
    """A metric of frames with a weight for each joint group; left and right share it.

    Parameters
    ----------
    name : str
        What it is called.
    by : {"positions", "velocities", "angles"}
        What is compared.
    shape : {"absolute", "squared", "sigmoid", "power"}
        The function F of P9.
    group_weights : mapping of str to float
        Weight of each of `GROUPS`, 0 or more; groups that are not named weigh nothing.
    scale, exponent : float, optional
        As in `FrameMetric`.

    Raises
    ------
    ValueError
        If a group is unknown, a weight negative, or what the shape needs is missing.

    Examples
    --------
    >>> legs = GroupMetric("legs", "positions", "absolute", {"calf": 3, "toe": 1})
    >>> legs.weights_for(["left_knee", "right_knee", "left_ankle"]).tolist()
    [0.375, 0.375, 0.25]

    """

    name: str
    by: By
    shape: Shape
    group_weights: Mapping[str, float] = field(default_factory=dict)
    scale: float | None = None
    exponent: float | None = None

    def __post_init__(self) -> None:
        FrameMetric(self.by, self.shape, self.scale, self.exponent)  # checks them
        unknown = [group for group in self.group_weights if group not in GROUPS]
        wrong = {group: w for group, w in self.group_weights.items() if not 0 <= w < np.inf}
        if unknown or wrong or not sum(self.group_weights.values()) > 0:
            raise ValueError(
                f"A metric of joint groups needs weights of 0 or more for some of {list(GROUPS)}, "
                f"one of them above 0; got {dict(self.group_weights)}."
            )

    def weights_for(self, names: Sequence[str]) -> np.ndarray:
        """Return a weight for each named point; they sum to 1.

        The points that stand for a group share its weight.

        Raises
        ------
        ValueError
            If none of the groups that weigh anything can be had from these points.

        """
        names = [str(name) for name in names]
        weights = dict.fromkeys(names, 0.0)
        for group, points in group_points(names, self.by).items():
            for point in points:
                weights[point] += self.group_weights.get(group, 0.0) / len(points)
        total = sum(weights.values())
        if not total > 0:
            weighed = [group for group, weight in self.group_weights.items() if weight > 0]
            raise ValueError(
                f"The metric {self.name!r} weighs {weighed} alone, and none of them can be had "
                f"from {names[:20]}."
            )
        return np.array([weights[name] for name in names]) / total

    def left_out(self, names: Sequence[str]) -> list[str]:
        """Return the groups that weigh something and that these points cannot tell.

        Examples
        --------
        >>> PUBLISHED["angles-absolute"].left_out(["head", "left_thigh", "left_calf"])
        ['clavicle', 'upper_arm']

        """
        there = group_points(names, self.by)
        return [g for g, weight in self.group_weights.items() if weight > 0 and g not in there]


class Printed(NamedTuple):
    """What figure 5 prints for a metric: how far it is off observers, its constants and weights."""

    difference: float
    constant: float
    normalisation: float
    weights: tuple[float, ...]


FIGURE_5: Mapping[tuple[By, Shape], Printed] = {
    ("angles", "squared"): Printed(23.335, 0.508, 659.272, (0, 0, 0.006, 0, 0, 0.669, 0.325, 0)),
    ("angles", "absolute"): Printed(
        18.448, 0.324, 19.537, (0.041, 0.003, 0.061, 0, 0, 0.622, 0.273, 0)
    ),
    ("angles", "sigmoid"): Printed(
        18.004, 0.312, 20.016, (0.039, 0.008, 0.076, 0, 0, 0.614, 0.263, 0)
    ),
    ("positions", "squared"): Printed(
        17.117, 0.290, 206.509, (0.062, 0, 0.551, 0.181, 0, 0, 0.050, 0.156)
    ),
    ("positions", "absolute"): Printed(
        13.423, 0.069, 9.909, (0.020, 0, 0.362, 0.429, 0, 0, 0, 0.189)
    ),
    ("positions", "sigmoid"): Printed(
        13.264, 0.059, 10.375, (0.015, 0, 0.344, 0.455, 0, 0, 0, 0.184)
    ),
    ("velocities", "squared"): Printed(
        25.779, 0.431, 1914.283, (0, 0, 0, 0, 0.605, 0, 0.298, 0.098)
    ),
    ("velocities", "absolute"): Printed(
        22.039, 0.193, 36.885, (0, 0, 0, 0, 0.551, 0, 0.298, 0.151)
    ),
    ("velocities", "sigmoid"): Printed(21.993, 0.189, 36.532, (0, 0, 0, 0, 0.564, 0, 0.306, 0.157)),
}
"""The nine rows as printed, weights in the order of `GROUPS`; angles have no hand and no toe. (The
text says that velocity takes hands, thighs and calves; the table says hands, calves and toes, and
is taken, A29.) Of a row only the weights are used, relative to each other."""


def _row(by: By, shape: Shape) -> GroupMetric:
    return GroupMetric(
        name=f"{by}-{shape}",
        by=by,
        shape=shape,
        group_weights=dict(zip(GROUPS, FIGURE_5[by, shape].weights, strict=True)),
    )


LEE = GroupMetric(
    "lee", "angles", "squared", dict.fromkeys(("upper_arm", "forearm", "thigh", "calf"), 1.0)
)
"""The angles' part of Lee et al. (2002): squared turns of shoulders, elbows, hips and knees, all
alike, nothing for neck, wrists, ankles and toes. Their pelvis and spine belong to no group of
figure 5 and are left out, as are their terms of velocity and of the root. (Which joints they take
is as later papers tell it; their own was not at hand.)"""

KOVAR = GroupMetric("kovar", "positions", "squared", dict.fromkeys(GROUPS, 1.0))
"""In the manner of Kovar, Gleicher and Pighin (2002): squared distances of points. Theirs are
points on the skin that all weigh the same, aligned in a window; here all joint groups weigh the
same, so that the head counts as much as both elbows together."""

PUBLISHED: Mapping[str, GroupMetric] = {
    **{f"{by}-{shape}": _row(by, shape) for by, shape in FIGURE_5},
    "lee": LEE,
    "kovar": KOVAR,
}
"""Metrics by name: ``"positions-sigmoid"`` and the other eight of figure 5, ``"lee"``, ``"kovar"``.
The weights that Wang and Bodenheimer (2003) found for Lee's are not among them: their table could
not be had."""


def metric_named(metric: str | ComparesFrames) -> ComparesFrames:
    """Return a published metric by its name; any other metric as it is.

    Examples
    --------
    >>> metric_named("positions-sigmoid").shape
    'sigmoid'

    """
    if not isinstance(metric, str):
        return metric
    if metric not in PUBLISHED:
        raise ValueError(f"metric={metric!r} is not known; give one of {list(PUBLISHED)}.")
    return PUBLISHED[metric]
