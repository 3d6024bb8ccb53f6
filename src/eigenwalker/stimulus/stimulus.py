"""The stimulus: figures, transforms, and how they are shown; one small JSON file."""

from __future__ import annotations

import json
import os
from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass, field, replace
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from eigenwalker.core.arguments import check_numbers
from eigenwalker.io.errors import UnreadableFile
from eigenwalker.stimulus.call_text import call_text, value_text, with_call
from eigenwalker.stimulus.dot_size import DOT_DEG, degrees_in_px, usual_dot_px, with_dots
from eigenwalker.stimulus.figure import Figure
from eigenwalker.stimulus.moving_dots import MovingDots
from eigenwalker.stimulus.player import Played, play, scene
from eigenwalker.stimulus.schema import (
    FORMAT,
    VERSION,
    Display,
    StimulusFile,
    Timing,
    View,
    checked,
)
from eigenwalker.stimulus.transform_defaults import Situation, resolve_transform

MAX_BYTES = 64_000_000
"""Size of a stimulus file."""


@dataclass(frozen=True, eq=False)
class Stimulus:
    """What an observer is shown, exactly: figures, a chain of transforms, view, timing, display.

    `make_stimulus` makes one, `then` adds a transform, `write_stimulus` writes it as a file, which
    Python and the browser play alike, to a millionth of a millimetre.

    Parameters
    ----------
    figures : sequence of Figure
        What moves.
    view, timing, display : View, Timing, Display
        How it is shown.
    transforms : sequence of mapping
        Changes of the figures, in this order: each a name and its parameters.
    provenance : mapping of str to str
        Source, licence, program.

    Raises
    ------
    ValueError
        If a part is wrong: a number out of range, an unknown transform, dots that are not there.

    See Also
    --------
    make_stimulus : makes it.
    write_stimulus : writes it.
    """

    figures: Sequence[Figure]
    view: View
    timing: Timing
    display: Display
    transforms: Sequence[Mapping[str, Any]] = ()
    provenance: Mapping[str, str] = field(default_factory=dict)

    def __post_init__(self) -> None:
        put = object.__setattr__
        put(self, "figures", tuple(self.figures))
        put(self, "transforms", tuple(step.to_dict() for step in self.file.transforms))
        put(self, "provenance", dict(self.provenance))

    @cached_property
    def file(self) -> StimulusFile:
        """The content of the file, checked."""
        return checked(
            {
                "format": FORMAT,
                "version": VERSION,
                "figures": [figure.to_dict() for figure in self.figures],
                "transforms": [dict(step) for step in self.transforms],
                "view": asdict(self.view),
                "timing": asdict(self.timing),
                "display": asdict(self.display),
                "provenance": self.provenance,
            }
        )

    @cached_property
    def scene(self) -> tuple[MovingDots, ...]:
        """The figures as the transforms leave them, in the scene, then the masks."""
        return scene(self.figures, self.file.transforms, self.view)

    def then(self, name: str, **parameters: Any) -> Stimulus:
        """Return the stimulus with one more transform at the end of its chain.

        `docs/stimuli.md` lists all transforms. Some parameters may be left out, such as the box of
        a scrambled walker; they are computed from the figures and stand in the file as numbers.

        Parameters
        ----------
        name : str
            Such as ``"invert"``, ``"scramble"``, ``"limb_dots"``.
        **parameters
            Those of the transform; ``figures`` may list those to act on.

        Returns
        -------
        Stimulus

        Examples
        --------
        >>> people = ew.load_population()
        >>> shown = ew.make_stimulus(people.walker(people.average)).then("invert")
        >>> shown.then("scramble", seed=3).transforms[-1]["name"]
        'scramble'
        """
        situation = Situation(
            self.figures, self.scene, self.view, self.display, self.timing.duration_s
        )
        step = resolve_transform(name, parameters, situation)
        words = [repr(name), *(f"{key}={value_text(given)}" for key, given in parameters.items())]
        provenance = with_call(self.provenance, f"then({', '.join(words)})")
        return replace(self, transforms=(*self.transforms, step), provenance=provenance)

    def sized(
        self,
        height_deg: float,
        *,
        viewing_distance_mm: float,
        px_per_cm: float,
        dot_deg: float | None = None,
        dot_px: float | None = None,
    ) -> Stimulus:
        """Return the stimulus with the first figure scaled to a visual angle.

        The figure's height is that of its dots as they are shown, from the lowest to the highest
        over one period, without their radius. Troje (2002) shows walkers of 5 degrees.

        Parameters
        ----------
        height_deg : float
            Visual angle of the height: ``2 atan(height / 2 / distance)``.
        viewing_distance_mm : float
            From the eye to the screen.
        px_per_cm : float
            Of the screen.
        dot_deg, dot_px : float, optional
            Diameter of dots. Left out, dots for which no size was given to `make_stimulus` get 0.12
            degrees, and others keep theirs; neither goes with the figure.

        Returns
        -------
        Stimulus
        """
        call = call_text(Stimulus.sized, locals())
        low, high = self.extent(0)
        screen = replace(self.display, viewing_distance_mm=viewing_distance_mm, px_per_cm=px_per_cm)
        height_px = degrees_in_px(screen, height_deg, "height_deg")
        display = replace(screen, px_per_mm=float(height_px / (high[1] - low[1])))
        if dot_deg is None and dot_px is None and display.dot_px == usual_dot_px(display):
            dot_deg = DOT_DEG
        display = with_dots(display, px=dot_px, deg=dot_deg)
        return replace(self, display=display, provenance=with_call(self.provenance, call))

    def whole_strides(self, n_strides: int | None = None) -> Stimulus:
        """Return the stimulus with a duration of whole strides of its first figure, so it loops.

        Parameters
        ----------
        n_strides : int, optional
            Left out, as many as come nearest to its duration.

        Returns
        -------
        Stimulus
            Trajectories, which have no period, keep their duration if no number is given.

        Raises
        ------
        ValueError
            If a number is given, and the figure has no period.
        """
        if self.figures[0].is_periodic:
            period_s = self.scene[0].period_s
            n_strides = n_strides or max(round(self.timing.duration_s / period_s), 1)
            return replace(self, timing=replace(self.timing, duration_s=n_strides * period_s))
        if n_strides is None:
            return self
        raise ValueError(
            f"n_strides={n_strides} is for walkers; trajectories have no period. Give duration_s."
        )

    def extent(self, figure: int | None = None) -> tuple[np.ndarray, np.ndarray]:
        """Return the smallest and largest coordinates in the picture, mm, of a figure or all."""
        chosen = self.scene[: len(self.figures)] if figure is None else [self.scene[figure]]
        played = [play([moving], self.view, moving.sample_times) for moving in chosen]
        places = np.concatenate([each.picture.reshape(-1, 2) for each in played])
        return np.nanmin(places, axis=0), np.nanmax(places, axis=0)

    @property
    def frame_times(self) -> np.ndarray:
        """Seconds of the frames of films and tables: k / rate for all below the duration."""
        n_frames = max(round(self.timing.duration_s * self.timing.rate_hz), 1)
        return np.arange(n_frames) / self.timing.rate_hz

    def play(self, time: ArrayLike | None = None) -> Played:
        """Return where every dot is at the given seconds, or at those of `frame_times`.

        Returns
        -------
        Played
            ``dots``, ``figures``, ``positions`` in the scene, ``visible``, ``picture`` in mm.
        """
        seconds = self.frame_times if time is None else np.atleast_1d(check_numbers(time, "time"))
        if np.abs(seconds).max(initial=0) > 1e5:
            raise ValueError("Times to play must be finite seconds, 100000 at most.")
        return play(self.scene, self.view, seconds)

    def to_dict(self) -> dict[str, Any]:
        """Return the content of the file, with all defaults filled in."""
        return self.file.to_dict()

    def to_json(self) -> str:
        """Return the text of the file: one figure and one transform a line."""
        return _text(self.to_dict())

    @classmethod
    def from_dict(cls, content: Any) -> Stimulus:
        """Return the stimulus that the content of a file describes.

        Raises
        ------
        ValueError
            If it is none: each problem with its place, what was expected, what is there.
        """
        file = checked(content)
        return cls(
            figures=[Figure.from_part(part) for part in file.figures],
            view=file.view,
            timing=file.timing,
            display=file.display,
            transforms=[step.to_dict() for step in file.transforms],
            provenance=file.provenance,
        )

    @classmethod
    def from_json(cls, text: str) -> Stimulus:
        """Return the stimulus that a text of JSON describes.

        Raises
        ------
        ValueError
            If it is no JSON, or no stimulus.
        """
        return cls.from_dict(_parsed(text))

    @classmethod
    def load(cls, path: str | os.PathLike[str]) -> Stimulus:
        """Return the stimulus of a file.

        Raises
        ------
        UnreadableFile
            If it holds none.
        """
        path = Path(path)
        if path.stat().st_size > MAX_BYTES:
            size = f"{path.stat().st_size} bytes"
            raise UnreadableFile(path.name, f"a stimulus of up to {MAX_BYTES} bytes", size)
        try:
            return cls.from_json(path.read_text(encoding="utf-8-sig"))
        except UnicodeDecodeError:
            raise UnreadableFile(path.name, "a stimulus in UTF-8", "other bytes") from None
        except ValueError as error:
            problem = str(error).rstrip(".").removeprefix("This is no stimulus: ")
            problem = problem.removeprefix("This is no JSON of a stimulus: ")
            got = f"a file that is none ({problem})"
            raise UnreadableFile(path.name, "a stimulus", got, "make it again") from None


def _text(content: dict[str, Any]) -> str:
    """Return content as JSON: one part a line, and one figure and one transform a line."""
    lines = []
    for name, part in content.items():
        if isinstance(part, list) and part:
            items = ",\n  ".join(map(_compact, part))
            lines.append(f'"{name}": [\n  {items}\n]')
        else:
            lines.append(f'"{name}": {_compact(part)}')
    return "{\n" + ",\n".join(lines) + "\n}\n"


def _parsed(text: str) -> Any:
    """Return the content of a text of JSON, refused where it is hostile."""
    if len(text) > MAX_BYTES:
        raise ValueError(f"A stimulus has {MAX_BYTES} letters at most; this has {len(text)}.")
    try:
        return json.loads(text, parse_constant=_refuse_constant, object_pairs_hook=_refuse_twice)
    except RecursionError:
        raise ValueError("A stimulus is not nested that deeply.") from None
    except json.JSONDecodeError as error:
        raise ValueError(f"This is no JSON of a stimulus: line {error.lineno} is none.") from None
    except ValueError as error:
        raise ValueError(f"This is no JSON of a stimulus: {error}.") from None


def _compact(part: Any) -> str:
    return json.dumps(part, separators=(",", ":"), allow_nan=False, ensure_ascii=False)


def _refuse_constant(name: str) -> Any:
    raise ValueError(f"it has a number {name}, and numbers must be finite")


def _refuse_twice(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
    content = dict(pairs)
    if len(content) < len(pairs):
        raise ValueError("an object has one name twice")
    return content
