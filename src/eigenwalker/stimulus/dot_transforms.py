"""Transforms of dots: scrambled places, dots that live for a moment, blobs, noise."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import Annotated, Literal

import numpy as np
from pydantic import Field, model_validator

from eigenwalker.core.skeleton import Skeleton
from eigenwalker.stimulus.moving_dots import Moments, MovingDots
from eigenwalker.stimulus.random_streams import Purpose, permutation, uniforms
from eigenwalker.stimulus.transform_types import (
    BoxSize,
    Context,
    Degrees,
    DotCount,
    Lifetime,
    Seed,
    Share,
    Switch,
    Transform,
    Vector,
    problem,
)

SHOWN_AXES = {"both": (1.0, 1.0), "horizontal": (1.0, 0.0), "vertical": (0.0, 1.0)}


class Scramble(Transform):
    """Put the dots elsewhere in the picture; each moves as it did.

    The mean place of each dot is moved in the picture, not in depth: to a random place in a box
    around the figure's middle (Cutting, 1981; Bertenthal and Pinto, 1994), or, with
    ``keep="structure"``, to the mean place of another dot. `directions` says in which direction
    places change. Keeps each dot's own motion exactly.
    """

    name: Literal["scramble"]
    seed: Seed = Field(description="seed of what is drawn at random")
    keep: Literal["nothing", "structure"] = Field("nothing", description="what of the places")
    box_mm: BoxSize = Field(description="width and height in the picture, mm")
    directions: Literal["both", "horizontal", "vertical"] = Field("both", description="that change")

    def apply(self, moving: MovingDots, context: Context) -> MovingDots:
        axes = context.observer[:2]
        seen = (moving.mean - moving.middle) @ axes.T
        if self.keep == "structure":
            order = permutation(Purpose.SCRAMBLE, self.seed, context.figure, size=len(moving.dots))
            wanted = seen[order]
        else:
            dots = np.arange(len(moving.dots))
            drawn = uniforms(Purpose.SCRAMBLE, self.seed, dots, context.figure, count=2)
            wanted = (drawn.reshape(-1, 2) - 0.5) * np.array(self.box_mm)
        moved = ((wanted - seen) * SHOWN_AXES[self.directions]) @ axes
        return moving.moved(lambda positions, time: positions + moved)


class LimbDots(Transform):
    """Show dots that live for a moment at random places of the body in place of the joints.

    Beintema and Lappe (2002): after its life a dot begins another one elsewhere on the limbs (or
    joints), so that no dot's motion shows the walk. With asynchrony 0 all begin anew at once, with
    1 one after the other. Keeps the posture that a frame shows, breaks the dots' paths.
    """

    name: Literal["limb_dots"]
    number: DotCount = Field(description="how many dots")
    lifetime_s: Lifetime = Field(description="how long each lives; null for ever")
    asynchrony: Share = Field(1.0, description="0 all anew at once, 1 one after the other")
    places: Literal["limbs", "joints"] = Field("limbs", description="where they are")
    seed: Seed = Field(description="seed of what is drawn at random")

    def apply(self, moving: MovingDots, context: Context) -> MovingDots:
        ends, reach = _segments(moving)
        dot_numbers = np.arange(self.number)
        ahead = self.asynchrony * dot_numbers / self.number

        def at(time: np.ndarray) -> Moments:
            posture, seen = moving.at(time)
            life = np.zeros((len(time), self.number))
            if self.lifetime_s is not None:
                life = np.floor(time[:, None] / self.lifetime_s + ahead)
            index = np.broadcast_to(dot_numbers + 65536 * context.figure, life.shape)
            drawn = uniforms(Purpose.LIMB_DOTS, self.seed, index, life, count=2)
            drawn = drawn.reshape(len(time), self.number, 2)
            if self.places == "joints":
                one = other = np.floor(drawn[..., 0] * len(moving.dots)).astype(int)
            else:
                chosen = np.searchsorted(reach, drawn[..., 0] * reach[-1], side="right")
                one, other = ends[np.minimum(chosen, len(ends) - 1)].transpose(2, 0, 1)
            moment = np.arange(len(time))[:, None]
            share = drawn[..., 1, None]
            positions = posture[moment, one] * (1 - share) + posture[moment, other] * share
            return Moments(positions, seen[moment, one] & seen[moment, other])

        return replace(moving, skeleton=Skeleton(numbered("dot", self.number)), at=at)


def _segments(moving: MovingDots) -> tuple[np.ndarray, np.ndarray]:
    """Ends of the segments, and the summed lengths up to the end of each in the mean posture."""
    ends = np.array(moving.skeleton.segment_ends, dtype=int).reshape(-1, 2)
    ways = moving.mean[ends[:, 0]] - moving.mean[ends[:, 1]]
    return ends, np.cumsum(np.sqrt(np.sum(np.nan_to_num(ways) ** 2, axis=1)))


def numbered(kind: str, number: int) -> tuple[str, ...]:
    """Return names of dots: dot_1, dot_2, ..."""
    return tuple(f"{kind}_{dot + 1}" for dot in range(number))


class Blur(Transform):
    """Draw each dot as a Gaussian blob of this standard deviation.

    Where blobs overlap their light adds up: with 80 mm and more the body is one blob that changes
    its shape (Barclay, Cutting and Kozlowski, 1978, experiment 3). In pixels the blobs are the same
    for all walkers; in mm they go with the figure. Keeps all places.
    """

    name: Literal["blur"]
    sd_mm: Annotated[float, Field(strict=True, ge=0, le=1e4)] | None = Field(
        None, description="standard deviation of the blobs at the walker's scale"
    )
    sd_px: Annotated[float, Field(strict=True, ge=0, le=1e4)] | None = Field(
        None, description="or in pixels of the picture"
    )

    @model_validator(mode="after")
    def _has_one_size(self) -> Blur:
        if (self.sd_mm is None) == (self.sd_px is None):
            raise problem("expected either sd_mm or sd_px")
        return self

    def apply(self, moving: MovingDots, context: Context) -> MovingDots:
        return replace(moving, blur_mm=self.sd_mm or 0.0, blur_px=self.sd_px or 0.0)


class Mask(Transform):
    """Return noise dots in a box that faces the observer, which become a figure of their own.

    Their places are random in each life. ``"random"``: they stay there; ``"linear"``: they move
    from there, and leaving the box come in at the other side; ``"scrambled"``: they move as the
    figure's dots move about their mean places, with `phases` each on a clock of its own (Cutting,
    Moore and Morrison, 1988; Bertenthal and Pinto, 1994).
    """

    adds_dots = True
    name: Literal["mask"]
    kind: Literal["random", "linear", "scrambled"] = Field(description="how the dots move")
    number: DotCount = Field(description="how many dots")
    box_mm: BoxSize = Field(description="width and height in the picture, mm")
    centre_mm: Vector = Field((0.0, 0.0, 0.0), description="of the box, in the scene")
    lifetime_s: Lifetime = Field(None, description="how long each stays; null for ever")
    speed_mm_s: float = Field(0.0, strict=True, ge=0, le=1e5, description="of linear motion")
    direction_deg: Degrees | None = Field(None, description="of linear motion; null for any")
    phases: Switch = Field(False, description="whether scrambled dots have clocks of their own")
    seed: Seed = Field(description="seed of what is drawn at random")

    def apply(self, moving: MovingDots, context: Context) -> MovingDots:
        width, height = self.box_mm
        right, up = context.observer[:2]
        dots = np.arange(self.number)
        motion = self._motion(moving) if self.kind == "scrambled" else None
        given = None if self.direction_deg is None else np.deg2rad(self.direction_deg)

        def at(time: np.ndarray) -> Moments:
            life = np.zeros((len(time), self.number))
            age = np.repeat(time[:, None], self.number, axis=1)
            if self.lifetime_s is not None:
                lived = time[:, None] / self.lifetime_s + dots / self.number
                life = np.floor(lived)
                age = (lived - life) * self.lifetime_s
            drawn = uniforms(
                Purpose.MASK, self.seed, np.broadcast_to(dots, life.shape), life, count=3
            ).reshape(len(time), self.number, 3)
            x, y = drawn[..., 0] * width, drawn[..., 1] * height
            if self.kind == "linear":
                heading = 2 * np.pi * drawn[..., 2] if given is None else given
                x = _wrapped(x + self.speed_mm_s * np.cos(heading) * age, width)
                y = _wrapped(y + self.speed_mm_s * np.sin(heading) * age, height)
            x, y = (x - width / 2)[..., None], (y - height / 2)[..., None]
            positions = np.array(self.centre_mm) + x * right + y * up
            visible = np.ones(life.shape, dtype=bool)
            if motion is not None:
                moved = motion(time)
                positions, visible = positions + moved.positions, moved.visible
            return Moments(positions, visible)

        skeleton = Skeleton(numbered("noise", self.number))
        return MovingDots(skeleton, at, moving.period_s, moving.blur_mm, moving.blur_px)

    def _motion(self, moving: MovingDots) -> Callable[[np.ndarray], Moments]:
        """How noise dots move about their places: the figure's dots about their means."""
        dots = np.arange(self.number)
        source = dots % len(moving.dots)
        mean = moving.mean[source]
        drawn = uniforms(Purpose.MASK, self.seed, dots, 0, count=3).reshape(-1, 3)[:, 2]
        ahead = drawn * moving.period_s

        def at(time: np.ndarray) -> Moments:
            if not self.phases:
                positions, visible = moving.at(time)
                return Moments(positions[:, source] - mean, visible[:, source])
            shown = [moving.at(time + shift) for shift in ahead]
            positions = np.stack([m.positions[:, s] for m, s in zip(shown, source, strict=True)], 1)
            visible = np.stack([m.visible[:, s] for m, s in zip(shown, source, strict=True)], 1)
            return Moments(positions - mean, visible)

        return at


def _wrapped(place: np.ndarray, size: float) -> np.ndarray:
    return place - np.floor(place / size) * size
