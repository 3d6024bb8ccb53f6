"""How different two frames are: a weighted sum of shaped distances of joints (Pražák, eq. 1-3)."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Literal, Protocol, get_args

import numpy as np

By = Literal["positions", "velocities", "angles"]
Shape = Literal["absolute", "squared", "sigmoid", "power"]

SHAPES: dict[Shape, Callable[[np.ndarray, float], np.ndarray]] = {
    "absolute": lambda d, _: d,
    "squared": lambda d, _: d * d,
    "sigmoid": lambda d, scale: d / (d + scale),
    "power": lambda d, exponent: d**exponent,
}
"""F of P9, given distances and the one number that the shape takes."""


SIGMOID_SCALE: Mapping[By, float] = {"positions": 1000.0, "velocities": 1000.0, "angles": 1.0}
"""What 1 stands for in d / (d + 1): a metre, a metre a second, a radian."""


class ComparesFrames(Protocol):
    """What maps and clip distances ask of a metric."""

    @property
    def by(self) -> By:
        """What of the joints is compared."""
        ...

    @property
    def shape(self) -> Shape:
        """The function F of P9."""
        ...

    @property
    def scale(self) -> float | None:
        """Distance at which the sigmoid is a half."""
        ...

    @property
    def exponent(self) -> float | None:
        """Power of the shape "power"."""
        ...

    def weights_for(self, names: Sequence[str]) -> np.ndarray:
        """Return a weight for each named point; they sum to 1."""
        ...


@dataclass(frozen=True)
class FrameMetric:
    """A distance of two frames: ``sum_k w_k F(d_k)`` over points that both have (P8).

    Parameters
    ----------
    by : {"positions", "velocities", "angles"}
        Whether d_k is the Euclidean distance of positions (mm) or velocities (mm/s), or the angle
        between orientations (radians, A26).
    shape : {"absolute", "squared", "sigmoid", "power"}
        F: d, d^2, d / (d + scale), d^exponent (P9).
    scale : float, optional
        For the sigmoid, the distance at which it is a half, in the unit of `by`. Left out, a metre,
        a metre a second or a radian (`SIGMOID_SCALE`): the paper's d / (d + 1) leaves the unit open
        (A28).
    exponent : float, optional
        For "power".
    weights : mapping of str to float, optional
        Weight of each point, 0 or more; points that are not named weigh nothing. Left out, all
        weigh the same. Weights are divided by their sum over the points that are compared.

    Raises
    ------
    ValueError
        If something is unknown, missing or negative.

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
        amiss = []
        if self.by not in get_args(By):
            amiss.append(f"by={self.by!r} is not known; give one of {list(get_args(By))}")
        if self.shape not in get_args(Shape):
            amiss.append(f"shape={self.shape!r} is not known; give one of {list(get_args(Shape))}")
        if self.shape == "power" and not _above_0(self.exponent):
            amiss.append(f"shape='power' needs exponent=..., above 0; got {self.exponent}")
        if self.shape == "sigmoid" and self.scale is not None and not _above_0(self.scale):
            amiss.append(f"scale={self.scale} is no distance above 0")
        if self.weights is not None:
            wrong = {name: w for name, w in self.weights.items() if not 0 <= w < np.inf}
            if wrong:
                amiss.append(f"weights must be finite and 0 or more; got {wrong}")
        if amiss:
            raise ValueError("This is no metric of frames: " + "; ".join(amiss) + ".")

    def weights_for(self, names: Sequence[str]) -> np.ndarray:
        """Return a weight for each named point, 0 or more; they sum to 1.

        Raises
        ------
        ValueError
            If none of them weighs anything.

        """
        given = dict.fromkeys(names, 1.0) if self.weights is None else self.weights
        weights = np.array([given.get(name, 0.0) for name in names])
        if not weights.sum() > 0:
            raise ValueError(
                f"None of the points {list(names)} weighs anything in this metric, which weighs "
                f"{sorted(given)}."
            )
        return weights / weights.sum()


def _above_0(number: float | None) -> bool:
    return number is not None and 0 < number < np.inf


POSITIONS = FrameMetric()
"""Mean Euclidean distance of positions, all points weighing the same."""


def shape_parameter(metric: ComparesFrames) -> float:
    """Return the one number that the shape of a metric takes; 1 where it takes none."""
    if metric.shape == "sigmoid":
        return SIGMOID_SCALE[metric.by] if metric.scale is None else float(metric.scale)
    return 1.0 if metric.exponent is None else float(metric.exponent)


def shaped(metric: ComparesFrames, distances: np.ndarray) -> np.ndarray:
    """Return F of distances, elementwise (P9)."""
    return SHAPES[metric.shape](distances, shape_parameter(metric))
