"""A figure of a stimulus: a walker or trajectories, where it is in the scene, and its file form."""

from __future__ import annotations

import itertools
from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Annotated, Any, Literal

import numpy as np
import xarray as xr
from pydantic import Field, PlainSerializer, PlainValidator, WithJsonSchema, model_validator

from eigenwalker.core.skeleton import LINKS, Skeleton
from eigenwalker.core.trajectories import check_trajectories, label_trajectories, sampling_rate
from eigenwalker.core.walker import Walker
from eigenwalker.stimulus.moving_dots import MovingDots, sampled, walking
from eigenwalker.stimulus.transform_types import (
    MAX_MARKERS,
    Degrees,
    Frequency,
    Harmonic,
    Length,
    MarkerName,
    Markers,
    Part,
    Switch,
    Vector,
    problem,
)

DECIMALS = 6
"""Of sampled trajectories in files, in mm."""
MAX_SAMPLES = 3_000_000
"""Numbers in the sampled trajectories of a figure."""
MAX_SAMPLE_MM = 1e7

Posture = Annotated[tuple[Vector, ...], Length(1, MAX_MARKERS)]
Phase = Annotated[float, Field(strict=True, ge=-1e3, le=1e3)]
ForwardSpeed = Annotated[float, Field(strict=True, ge=-1e5, le=1e5)] | None
Link = Annotated[tuple[MarkerName, ...], Length(2, 2)]


class WalkerPart(Part):
    """A walker: p0 + sum_i p_i sin(harmonic_i 2 pi f t + phase_i)."""

    markers: Markers = Field(description="names of the dots")
    p0: Posture = Field(description="mean posture: for each dot x, y, z in mm")
    p: Annotated[tuple[Posture, ...], Length(0, 64)] = Field(
        description="postures that ride on sines: the same each"
    )
    harmonics: Annotated[tuple[Harmonic, ...], Length(0, 64)] = Field(
        description="multiple of the frequency"
    )
    phases: Annotated[tuple[Phase, ...], Length(0, 64)] = Field(description="radians at 0 s")
    frequency_hz: Frequency = Field(description="strides a second")
    form: Literal["eigenposture", "fourier"] = Field("eigenposture", description="what was free")
    speed_mm_s: ForwardSpeed = Field(None, description="forward speed that was taken out")

    @model_validator(mode="after")
    def _lengths_agree(self) -> WalkerPart:
        n_markers = len(self.markers)
        lengths = {len(self.p0), *map(len, self.p)}
        if lengths != {n_markers}:
            raise problem(f"{n_markers} markers, but postures of {sorted(lengths)} dots")
        if not len(self.p) == len(self.harmonics) == len(self.phases):
            raise problem(
                f"{len(self.p)} postures ride on {len(self.harmonics)} harmonics with "
                f"{len(self.phases)} phases"
            )
        return self

    @classmethod
    def of(cls, walker: Walker) -> dict[str, Any]:
        """Return a walker as it stands in a file."""
        values = {name: getattr(walker, name) for name in cls.model_fields}
        return {
            **{name: v.tolist() if isinstance(v, np.ndarray) else v for name, v in values.items()},
            "speed_mm_s": _if_finite(walker.speed_mm_s),
        }

    def to_walker(self) -> Walker:
        """Return the walker that stands in a file."""
        values = self.model_dump()
        values["p"] = np.reshape(self.p, (-1, len(self.markers), 3))
        if self.speed_mm_s is None:
            del values["speed_mm_s"]
        return Walker(**values)


def _checked_samples(value: Any) -> np.ndarray:
    samples = value if isinstance(value, np.ndarray) else _as_array(value)
    if samples is None or samples.ndim != 3 or samples.shape[2] != 3 or len(samples) < 2:
        raise problem("expected two frames or more of dots of x, y, z (numbers or null)")
    if samples.size > MAX_SAMPLES:
        raise problem(f"expected {MAX_SAMPLES} numbers at most, got {samples.size}")
    if np.isinf(samples).any() or np.nanmax(np.abs(samples), initial=0) > MAX_SAMPLE_MM:
        raise problem(f"expected numbers within {MAX_SAMPLE_MM:g} mm")
    if not (~np.isnan(samples)).all(axis=2).any():
        raise problem("expected dots to be seen at some time, and none ever is")
    return samples


def _with_null(samples: np.ndarray) -> list[Any]:
    values = samples.astype(object)
    values[np.isnan(samples)] = None
    return values.tolist()


def _as_array(value: Any) -> np.ndarray | None:
    if not isinstance(value, list | tuple) or len(value) > MAX_SAMPLES:
        return None
    try:
        flat = itertools.chain.from_iterable(itertools.chain.from_iterable(value))
        if not set(map(type, flat)) <= {int, float, type(None)}:
            return None
        return np.array(value, dtype=float)
    except (TypeError, ValueError, OverflowError):
        return None


_NUMBER = {"type": "number", "minimum": -MAX_SAMPLE_MM, "maximum": MAX_SAMPLE_MM}
_PLACE = {"anyOf": [_NUMBER, {"type": "null"}]}
_DOT = {"type": "array", "items": _PLACE, "minItems": 3, "maxItems": 3}
_FRAME = {"type": "array", "items": _DOT, "minItems": 1, "maxItems": MAX_MARKERS}
Samples = Annotated[
    np.ndarray,
    PlainValidator(_checked_samples),
    PlainSerializer(_with_null),
    WithJsonSchema({"type": "array", "items": _FRAME, "minItems": 2}),
]
"""Numbers of shape (time, dot, 3), null where missing; an array, NaN where missing."""


class TrajectoriesPart(Part):
    """Sampled positions of dots."""

    markers: Markers = Field(description="names of the dots")
    rate_hz: float = Field(strict=True, gt=0, le=10_000, description="frames a second")
    repeat: Switch = Field(False, description="whether it begins anew after the last frame")
    samples: Samples = Field(description="frames of dots of x, y, z in mm; null is missing")
    speed_mm_s: ForwardSpeed = Field(None, description="forward speed that was taken out")

    @model_validator(mode="after")
    def _dots_have_names(self) -> TrajectoriesPart:
        if self.samples.shape[1] != len(self.markers):
            raise problem(f"samples do not have {len(self.markers)} dots")
        return self


class FigurePart(Part):
    """A figure as it stands in a file."""

    walker: WalkerPart | None = Field(None, description="coefficients, for what is periodic")
    trajectories: TrajectoriesPart | None = Field(None, description="samples, for what is not")
    segments: Annotated[tuple[Link, ...], Length(0, 5000)] = Field(
        (), description="who is joined to whom"
    )
    pairs: Annotated[tuple[Link, ...], Length(0, 500)] = Field(
        (), description="left dots with their right counterparts"
    )
    position_mm: Vector = Field(
        (0.0, 0.0, 0.0), description="where the figure's origin is in the scene"
    )
    heading_deg: Degrees = Field(0.0, description="by how much it is turned to its left")

    @property
    def motion(self) -> WalkerPart | TrajectoriesPart:
        """What moves: either the walker or the trajectories."""
        motion = self.walker or self.trajectories
        assert motion is not None  # as `_parts_agree` made sure
        return motion

    @model_validator(mode="after")
    def _parts_agree(self) -> FigurePart:
        if (self.walker is None) == (self.trajectories is None):
            raise problem("expected either walker or trajectories")
        linked = {name for link in (*self.segments, *self.pairs) for name in link}
        if unknown := sorted(linked - set(self.motion.markers)):
            raise problem(f"segments or pairs name {unknown[:5]}, which are no markers of it")
        paired = Counter(name for pair in self.pairs for name in pair)
        if any(count > 1 for count in paired.values()):
            raise problem("a marker stands in more than one pair")
        if any(one == other for one, other in self.segments):
            raise problem("a segment joins a marker to itself")
        return self


@dataclass(frozen=True, eq=False)
class Figure:
    """One figure in a scene.

    Parameters
    ----------
    motion : Walker, or DataArray of shape (time, marker, axis)
        Coefficients, for what is periodic; or evenly sampled trajectories, for what is not. The
        first phase of a walker is 0 at 0 s, as is the first frame of trajectories.
    skeleton : Skeleton
        Which markers are joined, and which are left-right counterparts.
    position_mm : sequence of float
        Where its origin is in the scene.
    heading_deg : float
        By how much it is turned to its left.
    repeat : bool
        Whether trajectories begin anew after their last frame, or hold still.

    See Also
    --------
    eigenwalker.Stimulus : Has one or more.
    """

    motion: Walker | xr.DataArray
    skeleton: Skeleton = LINKS
    position_mm: Sequence[float] = (0.0, 0.0, 0.0)
    heading_deg: float = 0.0
    repeat: bool = False

    @property
    def is_periodic(self) -> bool:
        """Whether it repeats: a walker, or trajectories that begin anew."""
        return self.repeat or isinstance(self.motion, Walker)

    def to_dict(self) -> dict[str, Any]:
        """Return the figure as it stands in a file, samples as an array."""
        if isinstance(self.motion, Walker):
            motion = {"walker": WalkerPart.of(self.motion)}
        else:
            speed = _if_finite(self.motion.attrs.get("speed_mm_s"))
            markers = self._skeleton.markers
            samples = {"markers": markers, **self._samples(self.motion), "speed_mm_s": speed}
            motion = {"trajectories": samples}
        return {
            **motion,
            "segments": self._skeleton.segments,
            "pairs": self._skeleton.pairs,
            "position_mm": tuple(map(float, self.position_mm)),
            "heading_deg": float(self.heading_deg),
        }

    def moving_dots(self) -> MovingDots:
        """Return the figure in its own frame as a function of time."""
        if isinstance(self.motion, Walker):
            return walking(self.motion, self._skeleton)
        return sampled(self._skeleton, **self._samples(self.motion))

    def _samples(self, walk: xr.DataArray) -> dict[str, Any]:
        """Samples, rate and repeat, rounded as in the file, so that a file plays alike."""
        return {
            "rate_hz": round(sampling_rate(walk), DECIMALS),
            "repeat": self.repeat,
            "samples": walk.values.round(DECIMALS),
        }

    @property
    def _skeleton(self) -> Skeleton:
        if isinstance(self.motion, Walker):
            return self.skeleton.restricted_to(self.motion.markers)
        markers = check_trajectories(self.motion).marker.values
        return self.skeleton.restricted_to(tuple(markers.tolist()))

    @classmethod
    def from_part(cls, part: FigurePart) -> Figure:
        """Return the figure that stands in a file."""
        given = part.motion
        if isinstance(given, WalkerPart):
            motion: Walker | xr.DataArray = given.to_walker()
        else:
            motion = label_trajectories(given.samples, markers=given.markers, rate_hz=given.rate_hz)
            if given.speed_mm_s is not None:
                motion.attrs["speed_mm_s"] = given.speed_mm_s
        body = Skeleton(given.markers, part.segments, part.pairs)  # pyright: ignore[reportArgumentType] - links have two ends
        repeat = isinstance(given, TrajectoriesPart) and given.repeat
        return cls(motion, body, part.position_mm, part.heading_deg, repeat)


def _if_finite(speed: object) -> float | None:
    return float(speed) if isinstance(speed, int | float) and np.isfinite(speed) else None
