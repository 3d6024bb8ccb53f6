"""One walker: a mean posture and postures that ride on sines."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from html import escape
from typing import Literal

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike

from eigenwalker.core.arguments import check_kind, check_numbers, check_whole
from eigenwalker.core.skeleton import JOINTS
from eigenwalker.core.trajectories import AXES, trajectories_at
from eigenwalker.core.walker_svg import N_FRAMES, beside, html_table, stride_svg

Form = Literal["eigenposture", "fourier"]


def check_walkers(walkers: Iterable[object]) -> None:
    """Raise an error unless there is one walker or more, and nothing else."""
    walkers = list(walkers)
    if not walkers:
        raise ValueError("Expected one walker or more, got none.")
    for walker in walkers:
        check_kind(walker, Walker, "a walker, as decompose_pca() returns it")


@dataclass(frozen=True, eq=False)
class CaptureFit:
    """What the decomposition of a capture found, and how well the walker explains it.

    Parameters
    ----------
    r2 : float
        Share of the variance about the mean posture that the decomposed walker explains.
    fourier_r2 : float
        The same share for `fourier`, which a walker in correspondence plays.
    residual_power : float
        Power of the residual over power of the input, mean posture included.
    relative_rms : float
        Root mean square of the residual over that of the movement, sqrt(1 - r2).
    variance_share : array of shape (component,)
        Share of variance of the first principal components, before any sine.
    sine_r2 : array of shape (component,)
        Coefficient of determination of the sine fitted to each eigenposture's scores.
    fourier : array of shape (2 * harmonic, marker, axis)
        Regression of the capture on sin 1, cos 1, sin 2, cos 2 ... on the walker's clock, in
        millimetres: the planes that correspondence rests on.
    eigenpostures : array of shape (component, marker, axis)
        Of the decomposition, before correspondence changes sign, order or axes.
    harmonics, phases : array of shape (component,)
        Those of `eigenpostures`.
    n_strides : float
        Number of strides in the capture.

    See Also
    --------
    decompose_pca, decompose_fourier : make it.

    References
    ----------
    Troje (2002), figs. 2 and 3. Troje (2002), The little difference.
    """

    r2: float
    fourier_r2: float
    residual_power: float
    relative_rms: float
    variance_share: np.ndarray
    sine_r2: np.ndarray
    fourier: np.ndarray
    eigenpostures: np.ndarray
    harmonics: np.ndarray
    phases: np.ndarray
    n_strides: float


@dataclass(frozen=True, eq=False)
class Walker:
    r"""A walk as a mean posture and postures that ride on sines.

    .. math:: p(t) = p_0 + \sum_i p_i \sin(h_i \omega (t - t_0) + \phi_i)

    Harmonics h are (1, 1, 2, 2) for two harmonics. In the eigenposture form phases are free; in the
    Fourier form they are fixed at (0, pi/2, 0, pi/2).

    Parameters
    ----------
    markers : sequence of str
        Marker names.
    p0 : array of shape (marker, axis)
        Mean posture in millimetres.
    p : array of shape (component, marker, axis)
        Eigenpostures in millimetres, multiplied by their amplitudes.
    harmonics : array of int of shape (component,)
        The multiple of the stride frequency on which each posture rides.
    phases : array of shape (component,)
        Radians.
    frequency_hz : float
        Strides, two steps each, a second.
    form : {"eigenposture", "fourier"}
        Whether phases are free or fixed: what counts as a feature.
    speed_mm_s : float
        Forward speed that was taken out of the walk; NaN where it is not known.
    time_origin_s : float
        Moment at which the first phase is 0, on the clock of the capture.
    fit : CaptureFit, optional
        How well the walker explains the capture it came from.

    Raises
    ------
    ValueError
        If shapes do not fit each other, a number is not finite or a harmonic is not whole.

    See Also
    --------
    decompose_pca, decompose_fourier : Make a walker of a walk.

    References
    ----------
    Troje (2002), Decomposing biological motion, eq. 3. Troje (2002), The little difference, eq. 1.

    Examples
    --------
    A foot that swings 200 mm to and fro, once a second:

    >>> walker = Walker(["foot"], [[0, 0, 50]], [[[200, 0, 0]]], [1], [0], 1.0)
    >>> walker.trajectories([0, 0.25]).sel(marker="foot", axis="x").values.tolist()
    [0.0, 200.0]
    """

    markers: tuple[str, ...]
    p0: np.ndarray
    p: np.ndarray
    harmonics: np.ndarray
    phases: np.ndarray
    frequency_hz: float
    form: Form = "eigenposture"
    speed_mm_s: float = float("nan")
    time_origin_s: float = 0.0
    fit: CaptureFit | None = None

    def __post_init__(self) -> None:
        set_field = object.__setattr__
        set_field(self, "markers", tuple(str(marker) for marker in self.markers))
        for name in ("p0", "p", "harmonics", "phases"):
            given = getattr(self, name)
            whole = name == "harmonics"
            values = check_whole(given, name) if whole else check_numbers(given, name, missing=True)
            values = values.copy()
            values.flags.writeable = False
            set_field(self, name, values)
        for name in ("frequency_hz", "speed_mm_s", "time_origin_s"):
            set_field(self, name, float(getattr(self, name)))
        if problems := self._problems():
            raise ValueError("This cannot walk: " + "; ".join(problems) + ".")

    def __repr__(self) -> str:
        explained = f", r2 {self.fit.r2:.3f}" if self.fit is not None else ""
        return (
            f"Walker({len(self.markers)} markers, {len(self.p)} postures in the {self.form} form, "
            f"{self.frequency_hz:.3f} Hz{explained})"
        )

    def _repr_html_(self) -> str:
        """A drawing that walks, and a table of facts, for notebooks."""
        facts = {
            "strides a second": f"{self.frequency_hz:.3f} Hz, {self.period_s:.2f} s each",
            "markers": str(len(self.markers)),
            "postures": f"{len(self.p)}, on harmonics {', '.join(map(str, self.harmonics))}",
            "form": self.form,
        }
        if np.isfinite(self.speed_mm_s):
            facts["speed"] = f"{self.speed_mm_s / 1000:.2f} m/s"
        if self.fit is not None:
            facts["R\N{SUPERSCRIPT TWO} of its capture"] = f"{self.fit.r2:.3f}"
        rows = [[escape(name), escape(value)] for name, value in facts.items()]
        return beside(self.moving_svg(), html_table(rows, title="Walker"))

    def moving_svg(self, *, height_px: int = 200) -> str:
        """Return one stride as SVG that plays for ever, in the colour of the text around it."""
        body = JOINTS.restricted_to(self.markers)
        time = self.time_origin_s + np.arange(N_FRAMES) * self.period_s / N_FRAMES
        return stride_svg(
            self.trajectories(time).values,
            period_s=self.period_s,
            segments=body.segment_ends,
            height_px=height_px,
            label=f"A walker of {len(self.markers)} points at {self.frequency_hz:.2f} Hz",
        )

    def _problems(self) -> list[str]:
        n_markers, n_components = len(self.markers), len(self.harmonics)
        problems: list[str] = []
        if len(set(self.markers)) < n_markers:
            problems.append("marker names come more than once")
        if not n_markers:
            problems.append("it has no markers")
        if self.p0.shape != (n_markers, 3):
            problems.append(
                f"the mean posture has shape {self.p0.shape}, not (marker, axis) = {n_markers, 3}"
            )
        if self.p.shape != (n_components, n_markers, 3):
            problems.append(
                f"the eigenpostures have shape {self.p.shape}, not (component, marker, axis) = "
                f"{n_components, n_markers, 3}"
            )
        if self.phases.shape != (n_components,):
            problems.append(f"there are {self.phases.size} phases for {n_components} postures")
        if (self.harmonics < 1).any():
            problems.append(f"harmonics must be 1 or more, got {self.harmonics.tolist()}")
        numbers = (self.p0, self.p, self.phases, [self.frequency_hz, self.time_origin_s])
        if not all(np.isfinite(values).all() for values in numbers):
            problems.append("some of its numbers are not finite")
        elif self.frequency_hz <= 0:
            problems.append(f"its frequency is {self.frequency_hz:.4g} Hz, which must be above 0")
        if self.form not in ("eigenposture", "fourier"):
            problems.append(f"form={self.form!r} is neither 'eigenposture' nor 'fourier'")
        return problems

    @property
    def mean_posture(self) -> xr.DataArray:
        """The mean posture p0 in millimetres: DataArray of shape (marker, axis)."""
        return xr.DataArray(
            self.p0,
            dims=("marker", "axis"),
            coords={"marker": list(self.markers), "axis": list(AXES)},
            name="mean_posture",
            attrs={"units": "mm"},
        )

    @property
    def eigenpostures(self) -> xr.DataArray:
        """The postures p in millimetres: DataArray of shape (component, marker, axis)."""
        return xr.DataArray(
            self.p,
            dims=("component", "marker", "axis"),
            coords={
                "component": np.arange(1, len(self.p) + 1),
                "marker": list(self.markers),
                "axis": list(AXES),
                "harmonic": ("component", self.harmonics),
                "phase": ("component", self.phases),
            },
            name="eigenpostures",
            attrs={"units": "mm"},
        )

    @property
    def period_s(self) -> float:
        """Seconds of one stride."""
        return 1 / self.frequency_hz

    def trajectories(self, time: ArrayLike | xr.DataArray) -> xr.DataArray:
        """Return the walk at the given times: Troje (2002), eq. 3.

        Parameters
        ----------
        time : array of shape (time,)
            Seconds on the walker's clock.

        Returns
        -------
        DataArray of shape (time, marker, axis)
            Positions in millimetres, walking in place.
        """
        time = np.atleast_1d(check_numbers(time, "time"))
        cycle = 2 * np.pi * self.frequency_hz * (time - self.time_origin_s)
        return trajectories_at(time, self.positions(cycle), self.markers)

    def positions(self, cycle: np.ndarray) -> np.ndarray:
        """Return the postures at angles of the stride, radians: array (angle, marker, axis), mm."""
        sines = np.sin(self.harmonics * cycle[:, None] + self.phases)
        return self.p0 + np.tensordot(sines, self.p, axes=1)


def fourier_coefficients(walker: Walker, n_harmonics: int) -> np.ndarray:
    """Return a walker's movement as coefficients of sin 1, cos 1, sin 2, cos 2 ...

    Expands ``p sin(h w t + phi) = p cos(phi) sin(h w t) + p sin(phi) cos(h w t)`` and sums the
    postures of each harmonic.

    Parameters
    ----------
    walker : Walker
        Of any form.
    n_harmonics : int
        Number of harmonics; those that the walker lacks are 0.

    Returns
    -------
    array of shape (2 * harmonic, marker, axis)
        Millimetres.

    See Also
    --------
    shift_origin : The same on a later clock.

    References
    ----------
    Troje (2002), The little difference, eq. 1.

    Examples
    --------
    >>> walker = Walker(["foot"], [[0, 0, 50]], [[[200, 0, 0]]], [1], [np.pi / 2], 1.0)
    >>> fourier_coefficients(walker, 1)[:, 0, 0].round(9).tolist()
    [0.0, 200.0]
    """
    check_walkers([walker])
    coefficients = np.zeros((2 * n_harmonics, *walker.p0.shape))
    for posture, harmonic, phase in zip(walker.p, walker.harmonics, walker.phases, strict=True):
        if harmonic <= n_harmonics:
            coefficients[2 * harmonic - 2] += posture * np.cos(phase)
            coefficients[2 * harmonic - 1] += posture * np.sin(phase)
    return coefficients
