"""Distances between two frames: weighted sums over joints (Pražák et al. 2010, eqs. 1 to 3)."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Literal, get_args

import numpy as np

from eigenwalker.core.arguments import check_numbers
from eigenwalker.metric.joint_groups import GROUPS, By, group_points

Shape = Literal["absolute", "squared", "sigmoid", "power"]

SHAPES: Mapping[Shape, Callable[[np.ndarray, float], np.ndarray]] = {
    "absolute": lambda d, _: d,
    "squared": lambda d, _: d * d,
    "sigmoid": lambda d, scale: d / (d + scale),
    "power": lambda d, exponent: d**exponent,
}
"""The functions F of Pražák et al. (2010, section 5), of distances and one parameter."""

SIGMOID_SCALE: Mapping[By, float] = {"positions": 1000.0, "velocities": 1000.0, "angles": 1.0}
"""The unit in d / (d + 1): a metre, a metre a second, a radian."""


@dataclass(frozen=True)
class FrameMetric:
    r"""A distance between two frames, with a weight for each point.

    .. math:: D(i, j) = \sum_k w_k F(d_k), \qquad w_k \ge 0, \quad \sum_k w_k = 1

    with :math:`d_k` the distance of point k in frame i of one clip from the same point in frame j
    of the other. The constant c of the paper is left out: a frame has no distance from itself.

    Parameters
    ----------
    by : {"positions", "velocities", "angles"}
        Whether d_k is the Euclidean distance of positions (mm, eq. 2) or velocities (mm/s, eq. 3),
        or the angle between orientations of bones (radians, eq. 1; `angle_between`).
    shape : {"absolute", "squared", "sigmoid", "power"}
        F(d): d, d^2, d / (d + scale) or d^exponent.
    scale : float, optional
        Distance at which the sigmoid is a half, in the unit of d. Left out, a metre, a metre a
        second or a radian (`SIGMOID_SCALE`): the d / (d + 1) of the paper leaves the unit open.
    exponent : float, optional
        For "power".
    weights : mapping of str to float, optional
        Weight of each point, 0 or more; other points have none. Left out, all are equal. Weights
        are divided by their sum over the points that both clips have.

    See Also
    --------
    GroupMetric : A weight for each joint group.
    PUBLISHED : Metrics by name.

    References
    ----------
    Pražák et al. (2010), eqs. 1 to 3 and section 5.

    Examples
    --------
    >>> metric = FrameMetric(shape="sigmoid", scale=100, weights={"left_ankle": 2, "head": 2})
    >>> metric.weights_for(["head", "left_ankle", "pelvis"]).tolist()
    [0.5, 0.5, 0.0]
    >>> shaped(metric, np.array([0.0, 100, 300])).tolist()
    [0.0, 0.5, 0.75]
    """

    by: By = "positions"
    shape: Shape = "absolute"
    scale: float | None = None
    exponent: float | None = None
    weights: Mapping[str, float] | None = None

    def __post_init__(self) -> None:
        problems = []
        for name, value, known in (("by", self.by, By), ("shape", self.shape, Shape)):
            if value not in get_args(known):
                problems.append(
                    f"{name}={value!r} is not known; give one of {list(get_args(known))}"
                )
        if self.shape == "power" and not _is_positive(self.exponent):
            problems.append(f"shape='power' needs exponent=..., above 0; got {self.exponent}")
        if self.shape == "sigmoid" and self.scale is not None and not _is_positive(self.scale):
            problems.append(f"scale={self.scale} is no distance above 0")
        wrong = {name: w for name, w in (self.weights or {}).items() if not 0 <= w < np.inf}
        if wrong:
            problems.append(f"weights must be finite and 0 or more; got {wrong}")
        if problems:
            raise ValueError("This is no metric of frames: " + "; ".join(problems) + ".")

    def weights_for(self, names: Sequence[str]) -> np.ndarray:
        """Return a weight for each named point, 0 or more; they sum to 1."""
        given = dict.fromkeys(names, 1.0) if self.weights is None else self.weights
        weights = np.array([given.get(name, 0.0) for name in names])
        if not weights.sum() > 0:
            raise ValueError(
                f"None of the points {list(names)} weighs anything in this metric, which weighs "
                f"{sorted(given)}."
            )
        return weights / weights.sum()


def _is_positive(number: float | None) -> bool:
    return number is not None and 0 < number < np.inf


@dataclass(frozen=True)
class GroupMetric:
    """A distance between two frames, with a weight for each joint group of figure 5.

    Parameters
    ----------
    name : str
        Name for tables and reports.
    by : {"positions", "velocities", "angles"}
        Whether d_k is a distance of positions (mm) or velocities (mm/s), or an angle between
        orientations of bones (radians).
    shape : {"absolute", "squared", "sigmoid", "power"}
        F(d): d, d^2, d / (d + scale) or d^exponent.
    group_weights : mapping of str to float
        Weight of each of `GROUPS`, 0 or more; other groups have none. The points of a group, left
        and right (`group_points`), share its weight.
    scale : float, optional
        Distance at which the sigmoid is a half, in the unit of d; left out, a metre, a metre a
        second or a radian.
    exponent : float, optional
        For "power".

    See Also
    --------
    FrameMetric : A weight for each point, and the equation.

    References
    ----------
    Pražák et al. (2010), eqs. 1 to 3 and fig. 5.

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

        The weight of a group without points falls to the others.
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

    def missing_groups(self, names: Sequence[str]) -> list[str]:
        """Return the groups that have a weight and no points among these."""
        present = group_points(names, self.by)
        return [g for g, weight in self.group_weights.items() if weight > 0 and g not in present]


Metric = FrameMetric | GroupMetric

POSITIONS = FrameMetric()
"""Mean Euclidean distance of positions, all points with the same weight."""


def shape_parameter(metric: Metric) -> float:
    """Return the scale or exponent of a metric; 1 where its shape has none."""
    if metric.shape == "sigmoid":
        return SIGMOID_SCALE[metric.by] if metric.scale is None else float(metric.scale)
    return 1.0 if metric.exponent is None else float(metric.exponent)


def shaped(metric: Metric, distances: np.ndarray) -> np.ndarray:
    """Return F(d) of a metric, elementwise.

    References
    ----------
    Pražák et al. (2010), section 5: functions F.
    """
    distances = check_numbers(distances, "distances", missing=True)
    if not distances.size or np.nanmin(distances) < 0:
        raise ValueError(f"distances must be 0 or more; got {distances.ravel()[:5].tolist()}.")
    return SHAPES[metric.shape](distances, shape_parameter(metric))
