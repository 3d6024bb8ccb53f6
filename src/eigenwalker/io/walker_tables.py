"""Walkers as tables of Fourier coefficients, in the layouts of other programs.

A table has a row for each coordinate of each marker and a column for the mean posture and for each
sine and cosine. Programs differ in which of sine and cosine comes first. The wrong
order plays each harmonic backwards, and shifts each differently.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import ArrayLike

from eigenwalker.core.arguments import check_numbers
from eigenwalker.core.axes import FORWARD_LEFT_UP, Layout, axes_matrix, from_rows, to_rows
from eigenwalker.core.skeleton import JOINTS
from eigenwalker.core.walker import Walker, check_walkers, fourier_coefficients
from eigenwalker.gait.body_points import find_origin
from eigenwalker.gait.heading import ground_speed

SIN_FIRST = ("mean", "sin1", "cos1", "sin2", "cos2")
"""The order of WDP2002, of the code of Moler's walker.m, and of the BML tables."""
COS_FIRST = ("mean", "cos1", "sin1", "cos2", "sin2")
"""The order of the BML's mm format (PsychBench), and of the text of Moler's article."""
BML_RATE_HZ = 120.0
"""Frames a second that are the unit of periods and speeds of the BML."""


def walker_from_table(
    table: ArrayLike,
    *,
    frequency_hz: float,
    markers: Sequence[str] = JOINTS.markers,
    columns: Sequence[str] = SIN_FIRST,
    layout: Layout = "planar",
    axes: Sequence[str] = FORWARD_LEFT_UP,
) -> Walker:
    """Return the walker that a table of Fourier coefficients describes.

    Parameters
    ----------
    table : array of shape (3 * marker, column)
        In millimetres.
    frequency_hz : float
        Strides, two steps each, a second.
    markers : sequence of str
        One name a marker, in the order of the table.
    columns : sequence of str
        What each column holds: ``"mean"``, ``"sin1"``, ``"cos1"``, ``"sin2"`` ...; `SIN_FIRST` and
        `COS_FIRST` are the usual ones.
    layout : {"planar", "interleaved"}
        Whether rows go x x x ... y y y ... z z z or x y z x y z ...
    axes : sequence of str
        Where the three axes of the table point: ``"forward"``, ``"left"``, ``"up"``, or the
        opposite of one.

    Returns
    -------
    Walker
        In the Fourier form; the 15 joints, if it is these, in the order of ``JOINTS``.

    Raises
    ------
    ValueError
        If shape, names and directions do not fit each other.

    See Also
    --------
    walker_to_table, walker_from_mm

    References
    ----------
    Moler (2016), walker.m: five columns, mean, sine and cosine of two harmonics.

    Examples
    --------
    A foot that swings 200 mm to and fro, in a table of which y is forward:

    >>> table = [[0, 0, 0], [0, 200, 0], [50, 0, 0]]
    >>> walker = walker_from_table(
    ...     table,
    ...     frequency_hz=1,
    ...     markers=["foot"],
    ...     columns=["mean", "sin1", "cos1"],
    ...     axes=["right", "forward", "up"],
    ... )
    >>> walker.trajectories([0.25]).values.tolist()
    [[[200.0, 0.0, 50.0]]]
    """
    values = check_numbers(table, "table", "3 * marker", "column")
    places = _column_places(columns)
    turn = axes_matrix(axes)
    if values.shape != (3 * len(markers), len(columns)):
        raise ValueError(
            f"Expected a table of 3 x {len(markers)} markers = {3 * len(markers)} rows and "
            f"{len(columns)} columns {tuple(columns)}, got shape {values.shape}."
        )
    postures = from_rows(values.T, layout)[[*places.values()]] @ turn
    walker = Walker(
        markers=tuple(markers),
        p0=postures[0],
        p=postures[1:],
        harmonics=np.array([int(name[3:]) for name in [*places][1:]]),
        phases=np.array([0.0 if name.startswith("sin") else np.pi / 2 for name in [*places][1:]]),
        frequency_hz=frequency_hz,
        form="fourier",
    )
    return _joints_in_order(walker)


def walker_to_table(
    walker: Walker,
    *,
    markers: Sequence[str] | None = None,
    columns: Sequence[str] = SIN_FIRST,
    layout: Layout = "planar",
    axes: Sequence[str] = FORWARD_LEFT_UP,
) -> np.ndarray:
    """Return a walker as a table of Fourier coefficients; `walker_from_table` takes it back.

    Parameters
    ----------
    walker : Walker
        Of any form. Its clock begins at its ``time_origin_s``.
    markers : sequence of str, optional
        Order of the markers in the table; the walker's if left out.
    columns, layout, axes
        As `walker_from_table` takes them.

    Returns
    -------
    array of shape (3 * marker, column)
        In millimetres.

    Raises
    ------
    ValueError
        If the table has no place for a harmonic of the walker, or a marker is not there.

    See Also
    --------
    walker_from_table, walker_to_mm

    Examples
    --------
    >>> walker = Walker(["foot"], [[0, 0, 50]], [[[200, 0, 0]]], [1], [0], 1.0)
    >>> walker_to_table(walker, columns=["mean", "cos1", "sin1"]).tolist()
    [[0.0, 0.0, 200.0], [0.0, 0.0, 0.0], [50.0, 0.0, 0.0]]
    """
    check_walkers([walker])
    places, turn = _column_places(columns), axes_matrix(axes)
    n_harmonics = len(columns) // 2
    lost = sorted({int(h) for h in walker.harmonics if h > n_harmonics})
    absent = [name for name in markers or () if name not in walker.markers]
    if lost or absent:
        raise ValueError(
            f"The columns {tuple(columns)} have no place for the harmonics {lost}; name more."
            if lost
            else f"The walker lacks the markers {absent}; it has {walker.markers}."
        )
    movement = fourier_coefficients(walker, n_harmonics)
    postures = np.concatenate([walker.p0[None], movement])
    rows = [walker.markers.index(name) for name in markers or walker.markers]
    table = np.empty((3 * len(rows), len(columns)))
    table[:, [*places.values()]] = to_rows(postures[:, rows] @ turn.T, layout).T
    return table


def walker_from_mm(
    matrix: ArrayLike,
    *,
    markers: Sequence[str] = JOINTS.markers,
    rate_hz: float = BML_RATE_HZ,
) -> Walker:
    """Return the walker of a matrix in the BML's mm ("motion model") format, as PsychBench has it.

    Parameters
    ----------
    matrix : array of shape (3 * marker + 1, 1 + 2 * harmonic)
        Rows: all x (forward), all y (left), all z (up), and a last one that tells the period in
        frames, a size factor (not applied), and the speed in millimetres a frame. Columns: mean,
        **cos 1, sin 1**, cos 2, sin 2 ...
    markers : sequence of str
        One name a marker; the 15 of the BML if left out.
    rate_hz : float
        Frames a second of period and speed.

    Returns
    -------
    Walker

    See Also
    --------
    walker_to_mm, walker_from_table

    Examples
    --------
    >>> swing = np.array([[0, 0, 200], [0, 0, 0], [50, 0, 0], [120, 1, 10]])
    >>> foot = walker_from_mm(swing, markers=["foot"])
    >>> foot.frequency_hz, foot.speed_mm_s
    (1.0, 1200.0)
    """
    values = check_numbers(matrix, "matrix", "3 * marker + 1", "column")
    if values.shape[1] < 3 or not values.shape[1] % 2 or not len(values):
        raise ValueError(
            "Expected a matrix of a mean, cosines and sines in columns, 3, 5, 7 ... of them, got "
            f"shape {values.shape}."
        )
    period, _, speed = values[-1, :3]
    if not 0.01 < period < np.inf:
        raise ValueError(f"Expected the period in frames in the last row, got {period:g}.")
    columns = _columns(values.shape[1] // 2, ("cos", "sin"))
    walker = walker_from_table(
        values[:-1], frequency_hz=rate_hz / period, markers=markers, columns=columns
    )
    return replace(walker, speed_mm_s=speed * rate_hz)


def walker_to_mm(
    walker: Walker, *, markers: Sequence[str] | None = None, rate_hz: float = BML_RATE_HZ
) -> np.ndarray:
    """Return a walker as a matrix in the BML's mm format; `walker_from_mm` takes it back.

    Parameters
    ----------
    walker : Walker
        Of any form; a speed that is not known becomes 0.
    markers : sequence of str, optional
        Order of the markers; for the 15 joints that of the BML if left out, else the walker's.
    rate_hz : float
        Frames a second that are the unit of period and speed.

    Returns
    -------
    array of shape (3 * marker + 1, 1 + 2 * harmonic)
        In mm. Rows: all x, all y, all z; the last one has the period in frames, the size factor 1
        and the speed in mm a frame. Columns: mean, cos 1, sin 1, cos 2, sin 2 ...

    See Also
    --------
    walker_from_mm, walker_to_table
    """
    check_walkers([walker])
    if markers is None and set(walker.markers) == set(JOINTS.markers):
        markers = JOINTS.markers
    n_harmonics = int(walker.harmonics.max(initial=1))
    columns = _columns(n_harmonics, ("cos", "sin"))
    last = np.zeros(len(columns))
    last[:3] = rate_hz / walker.frequency_hz, 1, np.nan_to_num(walker.speed_mm_s) / rate_hz
    return np.vstack([walker_to_table(walker, markers=markers, columns=columns), last])


def on_the_floor(walker: Walker) -> Walker:
    """Return a walker moved so that the origin is on the floor below its pelvis.

    Its speed is that of its feet on the ground, if it is not known.
    """
    walk = walker.trajectories(np.linspace(0, 2 * walker.period_s, 200, endpoint=False))
    origin = find_origin(walk.values, walker.markers)
    return replace(walker, p0=walker.p0 - origin, speed_mm_s=ground_speed(walker))


def _column_places(columns: Sequence[str]) -> dict[str, int]:
    """Return where the columns are, in the order mean, sin1, cos1, sin2 ..."""
    n_harmonics = len(columns) // 2
    names = _columns(n_harmonics, ("sin", "cos"))
    if sorted(columns) != sorted(names) or not n_harmonics:
        raise ValueError(
            f"columns={tuple(columns)} are no Fourier series; give 'mean' and 'sin1', 'cos1', "
            "'sin2' ..., both of each harmonic, in the order of the table."
        )
    return {name: list(columns).index(name) for name in names}


def _columns(n_harmonics: int, order: tuple[str, str]) -> list[str]:
    return ["mean"] + [f"{part}{h + 1}" for h in range(n_harmonics) for part in order]


def _joints_in_order(walker: Walker) -> Walker:
    if set(walker.markers) != set(JOINTS.markers):
        return walker
    order = [walker.markers.index(name) for name in JOINTS.markers]
    return replace(walker, markers=JOINTS.markers, p0=walker.p0[order], p=walker.p[:, order])
