"""The stimulus: figures, what is done to them, and how they are shown; one small JSON file."""

from __future__ import annotations

import json
import os
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import asdict, dataclass, field, replace
from functools import cached_property
from pathlib import Path
from typing import Any, Literal

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike

import eigenwalker
from eigenwalker.display.links import LINKS
from eigenwalker.display.projection import observer_axes
from eigenwalker.display.staging import DOT_MM
from eigenwalker.mocap.unreadable import UnreadableFile
from eigenwalker.skeleton import Skeleton
from eigenwalker.stimulus import content as file
from eigenwalker.stimulus.playing import Played, in_picture, play, scene
from eigenwalker.trajectories import check_trajectories, label_trajectories, sampling_rate
from eigenwalker.walker import Walker

MOST_BYTES = 64_000_000
FILLED = 0.84
"""Share of the picture that figures fill where no size is asked for."""
USUAL_S = 4.0
DECIMALS = 6
"""Of sampled trajectories in files, in mm."""

Style = Literal["dots", "sticks", "mannequin"]


@dataclass(frozen=True, eq=False)
class Figure:
    """Somebody or something in a scene.

    Parameters
    ----------
    motion : Walker, or DataArray of shape (time, marker, axis)
        Coefficients, for what is periodic; or evenly sampled trajectories, for what is not. The
        first phase of a walker is 0 at 0 s, as is the first frame of trajectories.
    skeleton : Skeleton
        Who is joined to whom, and who is whose counterpart.
    position_mm : sequence of float
        Where its origin is in the scene.
    heading_deg : float
        By how much it is turned to its left.
    repeat : bool
        Whether trajectories begin anew after their last frame, or hold still.

    """

    motion: Walker | xr.DataArray
    skeleton: Skeleton = LINKS
    position_mm: Sequence[float] = (0.0, 0.0, 0.0)
    heading_deg: float = 0.0
    repeat: bool = False

    def to_dict(self) -> dict[str, Any]:
        """Return the figure as it stands in a file, samples as an array."""
        if isinstance(self.motion, Walker):
            markers, motion = self.motion.markers, {"walker": walker_to_dict(self.motion)}
        else:
            walk = check_trajectories(self.motion)
            markers = tuple(walk.marker.values.tolist())
            speed = walk.attrs.get("speed_mm_s")
            motion = {
                "trajectories": {
                    "markers": markers,
                    "rate_hz": sampling_rate(walk),
                    "repeat": self.repeat,
                    "samples": walk.values.round(DECIMALS),
                    "speed_mm_s": _known(speed),
                }
            }
        body = self.skeleton.restricted_to(markers)
        return {
            **motion,
            "segments": body.segments,
            "pairs": body.pairs,
            "position_mm": tuple(map(float, self.position_mm)),
            "heading_deg": float(self.heading_deg),
        }

    @classmethod
    def from_dict(cls, figure: Mapping[str, Any]) -> Figure:
        """Return the figure that stands in the checked content of a file."""
        given = figure["walker"] or figure["trajectories"]
        if figure["walker"] is not None:
            motion: Walker | xr.DataArray = walker_from_dict(given)
        else:
            motion = label_trajectories(
                given["samples"], markers=given["markers"], rate_hz=given["rate_hz"]
            )
            if given["speed_mm_s"] is not None:
                motion.attrs["speed_mm_s"] = given["speed_mm_s"]
        body = Skeleton(given["markers"], figure["segments"], figure["pairs"])
        repeat = figure["walker"] is None and given["repeat"]
        return cls(motion, body, figure["position_mm"], figure["heading_deg"], repeat)


def walker_to_dict(walker: Walker) -> dict[str, Any]:
    """Return a walker as it stands in a stimulus file."""
    return {
        "markers": walker.markers,
        "p0": walker.p0.tolist(),
        "p": walker.p.tolist(),
        "harmonics": walker.harmonics.tolist(),
        "phases": walker.phases.tolist(),
        "frequency_hz": walker.frequency_hz,
        "form": walker.form,
        "speed_mm_s": _known(walker.speed_mm_s),
    }


def walker_from_dict(walker: Mapping[str, Any]) -> Walker:
    """Return the walker that stands in the checked content of a stimulus file."""
    speed = walker["speed_mm_s"]
    n_markers = len(walker["markers"])
    return Walker(
        markers=walker["markers"],
        p0=np.array(walker["p0"]),
        p=np.array(walker["p"], dtype=float).reshape(-1, n_markers, 3),
        harmonics=np.array(walker["harmonics"], dtype=int),
        phases=np.array(walker["phases"], dtype=float),
        frequency_hz=walker["frequency_hz"],
        form=walker["form"],
        speed_mm_s=float("nan") if speed is None else speed,
    )


def _known(speed: object) -> float | None:
    return float(speed) if isinstance(speed, int | float) and np.isfinite(speed) else None


@dataclass(frozen=True)
class View:
    """From where a stimulus is seen; see `project`. The centre is in the middle of the picture."""

    centre_mm: Sequence[float]
    view_deg: float = 0.0
    elevation_deg: float = 0.0
    eye_distance_mm: float | None = None


@dataclass(frozen=True)
class Timing:
    """How long a stimulus is shown, and the frames a second of films and tables of it."""

    duration_s: float
    rate_hz: float = 60.0


@dataclass(frozen=True)
class Display:
    """How a stimulus is drawn, and before what screen its observer sits."""

    px_per_mm: float
    width_px: int = 512
    height_px: int = 512
    dot_px: float = 8.0
    style: Style = "dots"
    colour: str = "#ffffff"
    background: str = "#000000"
    viewing_distance_mm: float | None = None
    px_per_cm: float | None = None


@dataclass(frozen=True, eq=False)
class Stimulus:
    """What an observer is shown, exactly: figures, a chain of transforms, view, timing, display.

    Made by `make_stimulus`, changed by `then`, kept as JSON, and played alike in Python and in the
    browser, to a millionth of a millimetre.

    Parameters
    ----------
    figures : sequence of Figure
        Who is seen.
    view, timing, display : View, Timing, Display
        How it is shown.
    transforms : sequence of mapping
        What is done to the figures, in this order: each a name and its parameters.
    provenance : mapping of str to str
        Source, licence, program.

    Raises
    ------
    ValueError
        If anything is amiss: a number out of range, an unknown transform, dots that are not there.

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
        put(self, "transforms", tuple(self._content["transforms"]))
        put(self, "provenance", dict(self.provenance))

    @cached_property
    def _content(self) -> dict[str, Any]:
        return file.checked(
            {
                "format": file.FORMAT,
                "version": file.VERSION,
                "figures": [figure.to_dict() for figure in self.figures],
                "transforms": list(self.transforms),
                "view": asdict(self.view),
                "timing": asdict(self.timing),
                "display": asdict(self.display),
                "provenance": self.provenance,
            }
        )

    def then(self, name: str, **parameters: Any) -> Stimulus:
        """Return the stimulus with one more transform at the end of its chain.

        `docs/stimuli.md` lists them all. Parameters that depend on the figures may be left out
        where `wishes` says so; they are worked out here and stand in the file as numbers.

        Parameters
        ----------
        name : str
            Such as ``"invert"``, ``"scramble"``, ``"limb_dots"``.
        **parameters
            As the transform takes them; ``figures`` may list those to act on.

        Returns
        -------
        Stimulus

        Examples
        --------
        >>> people = ew.load_population()
        >>> shown = make_stimulus(people.walker(people.average)).then("invert")
        >>> shown.then("scramble", seed=3).transforms[-1]["name"]
        'scramble'

        """
        from eigenwalker.stimulus.wishes import granted

        step = granted(self, name, parameters)
        return replace(self, transforms=(*self.transforms, step))

    def sized(self, height_deg: float, *, viewing_distance_mm: float, px_per_cm: float) -> Stimulus:
        """Return the stimulus with the first figure as high as an angle before the observer.

        What is measured is the greatest height of the figure's dots as they are shown, from lowest
        to highest over one period, without their radius. Troje (2002) shows walkers of 5 degrees.

        Parameters
        ----------
        height_deg : float
            Degrees of visual angle: ``2 atan(height / 2 / distance)``.
        viewing_distance_mm : float
            From the eye to the screen.
        px_per_cm : float
            Of the screen.

        Returns
        -------
        Stimulus

        """
        low, high = self._extent(0)
        tall_px = 2 * viewing_distance_mm * np.tan(np.deg2rad(height_deg) / 2) * px_per_cm / 10
        scale = float(tall_px / (high[1] - low[1]))
        display = replace(
            self.display,
            px_per_mm=scale,
            dot_px=self.display.dot_px * scale / self.display.px_per_mm,
            viewing_distance_mm=viewing_distance_mm,
            px_per_cm=px_per_cm,
        )
        return replace(self, display=display)

    def _extent(self, figure: int | None = None) -> tuple[np.ndarray, np.ndarray]:
        """Least and greatest places in the picture of a figure, or of all, over one period."""
        figures = scene(self._content)
        chosen = figures[: len(self.figures)] if figure is None else [figures[figure]]
        seen = [
            in_picture(moving.at(np.arange(64) * moving.period_s / 64).positions,
                       self._content["view"])[0].reshape(-1, 2)
            for moving in chosen
        ]  # fmt: skip
        places = np.concatenate(seen)
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
        seconds = self.frame_times if time is None else np.atleast_1d(np.asarray(time, float))
        if not np.isfinite(seconds).all() or np.abs(seconds).max(initial=0) > 1e5:
            raise ValueError("Times to play must be finite seconds, 100000 at most.")
        return play(self._content, seconds)

    def to_dict(self) -> dict[str, Any]:
        """Return the content of the file, with all defaults filled in."""
        content = json.loads(json.dumps(self._content, default=_plain, allow_nan=False))
        for figure in content["figures"]:
            for name in ("walker", "trajectories"):
                if figure[name] is None:
                    del figure[name]
        return content

    def to_json(self) -> str:
        """Return the text of the file: one figure and one transform a line."""
        lines = []
        for name, part in self.to_dict().items():
            if isinstance(part, list):
                items = ",\n  ".join(map(_compact, part))
                lines.append(f'"{name}": [\n  {items}\n]' if part else f'"{name}": []')
            else:
                lines.append(f'"{name}": {_compact(part)}')
        return "{\n" + ",\n".join(lines) + "\n}\n"

    def save(self, path: str | os.PathLike[str]) -> Path:
        """Write the stimulus to a JSON file, which appears whole, and return its path."""
        path = Path(path)
        whole = path.with_name(f".{path.name}.part")
        try:
            whole.write_text(self.to_json(), encoding="utf-8")
            os.replace(whole, path)
        finally:
            whole.unlink(missing_ok=True)
        return path

    @classmethod
    def from_dict(cls, content: Any) -> Stimulus:
        """Return the stimulus that the content of a file describes.

        Raises
        ------
        ValueError
            If anything is amiss.

        """
        kept = file.checked(content)
        return cls(
            figures=[Figure.from_dict(figure) for figure in kept["figures"]],
            view=View(**kept["view"]),
            timing=Timing(**kept["timing"]),
            display=Display(**kept["display"]),
            transforms=kept["transforms"],
            provenance=kept["provenance"],
        )

    @classmethod
    def from_json(cls, text: str) -> Stimulus:
        """Return the stimulus that a text of JSON describes.

        Raises
        ------
        ValueError
            If it is no JSON, or no stimulus.

        """
        if len(text) > MOST_BYTES:
            raise ValueError(f"A stimulus has {MOST_BYTES} letters at most; this has {len(text)}.")
        try:
            content = json.loads(
                text, parse_constant=_refuse_constant, object_pairs_hook=_refuse_twice
            )
        except RecursionError:
            raise ValueError("A stimulus is not nested that deeply.") from None
        except ValueError as error:
            raise ValueError(f"This is no JSON of a stimulus: {error}.") from None
        return cls.from_dict(content)

    @classmethod
    def load(cls, path: str | os.PathLike[str]) -> Stimulus:
        """Return the stimulus of a file.

        Raises
        ------
        UnreadableFile
            If it holds none.

        """
        path = Path(path)
        if path.stat().st_size > MOST_BYTES:
            size = f"{path.stat().st_size} bytes"
            raise UnreadableFile(path.name, f"a stimulus of up to {MOST_BYTES} bytes", size)
        try:
            return cls.from_json(path.read_text(encoding="utf-8-sig"))
        except UnicodeDecodeError:
            raise UnreadableFile(path.name, "a stimulus in UTF-8", "other bytes") from None
        except ValueError as error:
            came = str(error).rstrip(".")
            raise UnreadableFile(path.name, "a stimulus", came, "make it anew") from None


def make_stimulus(
    figures: Walker | xr.DataArray | Figure | Iterable[Walker | xr.DataArray | Figure],
    *,
    view_deg: float = 30.0,
    elevation_deg: float = 0.0,
    eye_distance_mm: float | None = None,
    duration_s: float | None = None,
    rate_hz: float = 60.0,
    style: Style = "dots",
    size_px: tuple[int, int] = (512, 512),
    colour: str = "#ffffff",
    background: str = "#000000",
    provenance: Mapping[str, str] | None = None,
) -> Stimulus:
    """Return a stimulus of one figure, or of several in one scene, as large as the picture allows.

    Parameters
    ----------
    figures : Walker, trajectories, Figure, or several of them
        Who is seen. A `Figure` says where it stands and how it is joined too.
    view_deg, elevation_deg : float
        From where; 0 is the front, 90 in profile to the right.
    eye_distance_mm : float, optional
        From the eye to the middle of the scene, for a perspective picture.
    duration_s : float, optional
        Left out, 4 for walkers, and what the shortest of the trajectories lasts.
    rate_hz : float
        Frames a second of films and tables.
    style : {"dots", "sticks", "mannequin"}
        What is drawn; the mannequin is for the browser.
    size_px : (width, height)
        Of the picture.
    colour, background : str
        As in ``"#ffffff"``.
    provenance : mapping of str to str, optional
        Source, licence, citation of what is shown; the program's version is added.

    Returns
    -------
    Stimulus

    Examples
    --------
    >>> hop = ew.Walker(["foot"], [[0, 0, 50]], [[[0, 0, 40]]], [1], [0], 1.0)
    >>> shown = make_stimulus(hop, view_deg=0, duration_s=1).then("invert")
    >>> shown.play([0.25]).positions[0, 0].round(6).tolist()
    [0.0, 0.0, 10.0]

    """
    one = isinstance(figures, Walker | xr.DataArray | Figure)
    given = [figures] if one else list(figures)  # pyright: ignore[reportArgumentType] - several
    whole = [item if isinstance(item, Figure) else Figure(item) for item in given]  # pyright: ignore[reportArgumentType] - the same
    if not whole:
        raise ValueError("There is nobody to show; give one figure or more.")
    if duration_s is None:
        walks = [figure.motion for figure in whole if isinstance(figure.motion, xr.DataArray)]
        duration_s = min((float(np.ptp(walk.time.values)) for walk in walks), default=USUAL_S)
    program = f"eigenwalker {eigenwalker.__version__}"
    bare = Stimulus(
        figures=whole,
        view=View((0.0, 0.0, 0.0), view_deg, elevation_deg),
        timing=Timing(duration_s, rate_hz),
        display=Display(1.0, *size_px, style=style, colour=colour, background=background),
        provenance={**(provenance or {}), "program": program},
    )
    return _fitted(bare, eye_distance_mm)


def _fitted(bare: Stimulus, eye_distance_mm: float | None) -> Stimulus:
    """A stimulus with its figures in the middle of the picture and as large as it allows."""
    low, high = bare._extent()
    axes = observer_axes(bare.view.view_deg, bare.view.elevation_deg)
    middles = np.mean([moving.middle for moving in scene(bare._content)], axis=0)
    middle = np.array([*(low + high) / 2, axes[2] @ middles]) @ axes
    view = replace(
        bare.view, centre_mm=tuple(middle.round(3).tolist()), eye_distance_mm=eye_distance_mm
    )
    extent = np.maximum(high - low, 100.0)
    room = FILLED * np.array([bare.display.width_px, bare.display.height_px])
    scale = float((room / extent).min())
    display = replace(bare.display, px_per_mm=scale, dot_px=max(DOT_MM * scale, 2.0))
    return replace(bare, view=view, display=display)


def _compact(part: Any) -> str:
    return json.dumps(part, separators=(",", ":"), allow_nan=False, ensure_ascii=False)


def _plain(value: Any) -> Any:
    """Arrays of samples as lists, None where missing."""
    assert isinstance(value, np.ndarray)
    plain = value.astype(object)
    plain[np.isnan(value)] = None
    return plain.tolist()


def _refuse_constant(name: str) -> Any:
    raise ValueError(f"it has a number {name}, and numbers must be finite")


def _refuse_twice(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
    kept = dict(pairs)
    if len(kept) < len(pairs):
        raise ValueError("an object has one name twice")
    return kept
