"""Correspondence: sign, order, axes and phase of the eigenpostures of many walkers.

The principal components of one walk are determined up to sign, and where two of them explain nearly
the same variance, up to any rotation; in real walks components 2 and 3 change places. Averages over
walkers make sense only if eigenposture i means the same in each of them. The papers do not say
how; here

1. each walk gives the plane in which its postures move at each harmonic, by regression on the sine
   and cosine of that harmonic, whatever the order of its components;
2. the plane of the average walker has its own principal axes: its eigenpostures;
3. each walker's axes are rotated within its plane as near as possible to those (orthogonal
   Procrustes), which also determines signs; phases follow from the axes;
4. the first phase is set to 0, where the left ankle is ahead of the right.

A walker whose eigenpostures still do not resemble the average's is flagged, and left out of it.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np

from eigenwalker.core.arguments import check_kind, check_numbers
from eigenwalker.core.fourier import shift_origin
from eigenwalker.core.walker import Form, Walker, check_walkers, fourier_coefficients
from eigenwalker.decomposition.fourier import origin_angle
from eigenwalker.decomposition.pca import is_negative
from eigenwalker.population.features import FeatureLayout, wrap_phase

_MAX_ROUNDS = 50
_CONVERGED = 1e-10
MIN_SIMILARITY = 0.3
"""Least cosine between an eigenposture and the average walker's that counts as the same."""
MIN_SHARE = 0.002
"""Share of a walker's movement below which a posture is not compared. A typical walker's fourth
posture has 0.01."""


@dataclass(frozen=True, eq=False)
class ReferenceWalker:
    """What walkers are brought into correspondence with.

    See Also
    --------
    correspond : makes it.
    """

    axes: np.ndarray
    average: np.ndarray
    form: Form
    markers: tuple[str, ...]


@dataclass(frozen=True, eq=False)
class Correspondence:
    """How far correspondence holds for some walkers.

    Parameters
    ----------
    reference : ReferenceWalker
    similarity : array of shape (walker, component)
        Cosine between each eigenposture and the average walker's.
    flags : tuple of str
        For each walker, why correspondence does not hold; empty where it does.

    See Also
    --------
    correspond : makes it.

    References
    ----------
    Troje (2002), eq. 3: postures and phases that are the same in every walker.
    """

    reference: ReferenceWalker
    similarity: np.ndarray
    flags: tuple[str, ...]


class _Aligned(NamedTuple):
    """Postures (walker, component, feature), phases and similarity (walker, component)."""

    postures: np.ndarray
    phases: np.ndarray
    similarity: np.ndarray


def correspond(
    walkers: Sequence[Walker], *, leave_out: Sequence[bool] | None = None
) -> tuple[tuple[Walker, ...], Correspondence]:
    r"""Return walkers in correspondence, and how far correspondence holds.

    For each walker and harmonic, the unit axes U (2, feature) of the plane of its movement are
    rotated or mirrored to those of the average walker, A:

    .. math:: R = \arg\min_{R^T R = I} \lVert R U - A \rVert

    The clock is then shifted so that the first phase is 0. Average and axes are found again until
    they no longer change. In the Fourier form there are no free axes: the clock of a walker is
    shifted by half a stride if its first harmonic is opposite to the average's. A walker is flagged
    if a posture has a cosine below 0.3 with the average's; postures with less than 0.002 of the
    walker's movement are not compared.

    Parameters
    ----------
    walkers : sequence of Walker
        All of the same markers, form and number of harmonics.
    leave_out : sequence of bool, optional
        Walkers that must not shape the average; they are brought into correspondence too.

    Returns
    -------
    walkers : tuple of Walker
    correspondence : Correspondence

    Raises
    ------
    ValueError
        If they differ in markers, form or number of harmonics.

    See Also
    --------
    correspond_to : One walker in correspondence with others.
    match_sign_and_order : Sign and order only, as in the paper.

    References
    ----------
    Not from the papers: Troje (2002) averages eigenpostures (eq. 5) without saying how they were
    matched. Schönemann (1966), Psychometrika 31, 1-10: the orthogonal Procrustes problem.
    """
    _check_comparable(walkers)
    trusted = np.ones(len(walkers), dtype=bool)
    if leave_out is not None and not np.all(leave_out):
        trusted = ~np.asarray(leave_out, dtype=bool)
    coefficients, clocks = _canonical(walkers, _n_harmonics(walkers[0]))
    reference = _average_axes(coefficients[trusted], walkers[0])
    rounds = 0
    while True:
        rounds += 1
        aligned, shifts = _align(coefficients, reference)
        coefficients, clocks = _shift_origins(coefficients, shifts), clocks + shifts
        flags = _flags(aligned, reference)
        unflagged = trusted & np.array([not flag for flag in flags])
        trusted = unflagged if unflagged.any() else trusted
        previous, reference = reference, _average_axes(coefficients[trusted], walkers[0])
        change = np.abs(reference.axes - previous.axes).max()
        if change < _CONVERGED or rounds == _MAX_ROUNDS:
            break
    aligned_walkers = tuple(
        _with_postures(walker, aligned, number, clocks[number])
        for number, walker in enumerate(walkers)
    )
    return aligned_walkers, Correspondence(previous, aligned.similarity, flags)


def correspond_to(walker: Walker, reference: ReferenceWalker) -> tuple[Walker, np.ndarray, str]:
    """Return one walker in correspondence with a population.

    Parameters
    ----------
    walker : Walker
        Of the same markers, form and number of harmonics as the population.
    reference : ReferenceWalker
        ``population.correspondence.reference``, as `correspond` finds it.

    Returns
    -------
    walker : Walker
    similarity : array of shape (component,)
        Cosine between its eigenpostures and the average walker's.
    flag : str
        Why correspondence does not hold; empty where it does.

    See Also
    --------
    correspond : Many walkers at once, and how it is done.

    References
    ----------
    Not from the papers: Troje (2002) averages eigenpostures (eq. 5) without saying how they were
    matched.
    """
    check_walkers([walker])
    check_kind(reference, ReferenceWalker, "population.correspondence.reference")
    if walker.markers != reference.markers or walker.form != reference.form:
        raise ValueError(
            f"The walker has {len(walker.markers)} markers in the {walker.form} form, the "
            f"population {len(reference.markers)} in the {reference.form} form; decompose it "
            "the same way, from the same joints."
        )
    coefficients, clocks = _canonical([walker], len(reference.axes))
    aligned, shifts = _align(coefficients, reference)
    (flag,) = _flags(aligned, reference)
    return _with_postures(walker, aligned, 0, clocks[0] + shifts[0]), aligned.similarity[0], flag


def posture_correlations(postures: np.ndarray) -> np.ndarray:
    """Return how similar postures are over all pairs of walkers.

    Parameters
    ----------
    postures : array of shape (walker, component, marker, axis)
        Mean postures (one component) or eigenpostures.

    Returns
    -------
    array of shape (component,)
        Mean Pearson correlation over all pairs of walkers.

    See Also
    --------
    Population.posture_correlations : of a whole population.

    References
    ----------
    Troje (2002), Decomposing biological motion.

    Examples
    --------
    >>> rng = np.random.default_rng(0)
    >>> same = rng.normal(size=(1, 1, 15, 3)) * [[[[1.0]]], [[[2.0]]]]
    >>> posture_correlations(same).round(6).tolist()
    [1.0]
    """
    postures = check_numbers(postures, "postures", "walker", "component", "marker", "axis", least=2)
    n_walkers, n_components = postures.shape[:2]
    flat = postures.reshape(n_walkers, n_components, -1)
    centred = flat - flat.mean(axis=-1, keepdims=True)
    length = np.linalg.norm(centred, axis=-1, keepdims=True)
    unit = centred / np.where(length > 0, length, 1)
    # The sum over all pairs is the square of the sum less the pairs of each with itself.
    of_pairs = (unit.sum(axis=0) ** 2).sum(axis=-1) - (unit**2).sum(axis=(0, 2))
    return of_pairs / (n_walkers * (n_walkers - 1))


def match_sign_and_order(walkers: Sequence[Walker]) -> np.ndarray:
    """Return the eigenpostures of the decomposition, with only sign and order made to agree.

    The correspondence that the paper implies: components are sorted by harmonic, then by variance;
    signs are those of the first walker, then those of the mean, until none changes.

    Parameters
    ----------
    walkers : sequence of Walker

    Returns
    -------
    array of shape (walker, component, marker, axis)

    See Also
    --------
    correspond : axes and phases agree too.

    References
    ----------
    Troje (2002), correlations of eigenpostures.
    """
    check_walkers(walkers)
    postures: list[np.ndarray] = []
    for walker in walkers:
        p, harmonics = walker.p, walker.harmonics
        if walker.fit is not None:
            p, harmonics = walker.fit.eigenpostures, walker.fit.harmonics
        postures.append(p[np.argsort(harmonics, kind="stable")])
    stacked = np.stack(postures)
    towards = stacked[0]
    for _ in range(20):
        sign = np.sign(np.einsum("wcma,cma->wc", stacked, towards))
        stacked = stacked * np.where(sign == 0, 1, sign)[..., None, None]
        towards = stacked.mean(axis=0)
        if (sign >= 0).all():
            break
    return stacked


def _check_comparable(walkers: Sequence[Walker]) -> None:
    check_walkers(walkers)
    first = FeatureLayout.of(walkers[0])
    for number, walker in enumerate(walkers):
        same = walker.markers == first.markers and walker.form == first.form
        if not same or len(walker.harmonics) != len(first.harmonics):
            raise ValueError(
                f"Walker {number} has {len(walker.markers)} markers and {len(walker.harmonics)} "
                f"postures in the {walker.form} form, walker 0 has {len(first.markers)} and "
                f"{len(first.harmonics)} in the {first.form} form; decompose all the same way."
            )


def _n_harmonics(walker: Walker) -> int:
    return (len(walker.harmonics) + 1) // 2


def _canonical(walkers: Sequence[Walker], n_harmonics: int) -> tuple[np.ndarray, np.ndarray]:
    """Fourier coefficients on a clock that all share, and by which angle each was shifted."""
    coefficients: list[np.ndarray] = []
    clocks: list[float] = []
    for walker in walkers:
        known = _movement(walker, n_harmonics)
        clock = origin_angle(known, walker.markers)
        coefficients.append(shift_origin(known, clock).reshape(2 * n_harmonics, -1))
        clocks.append(clock)
    return np.stack(coefficients), np.array(clocks)


def _movement(walker: Walker, n_harmonics: int) -> np.ndarray:
    """Fourier coefficients of a walker: of its capture if as decomposed, else as played."""
    fit = walker.fit
    as_decomposed = fit is not None and np.array_equal(walker.p, fit.eigenpostures)
    if fit is not None and as_decomposed and len(fit.fourier) == 2 * n_harmonics:
        return fit.fourier
    return fourier_coefficients(walker, n_harmonics)


def _shift_origins(coefficients: np.ndarray, angles: np.ndarray) -> np.ndarray:
    return np.stack([shift_origin(*each) for each in zip(coefficients, angles, strict=True)])


def _average_axes(coefficients: np.ndarray, walker: Walker) -> ReferenceWalker:
    """Principal axes of the average walker at each harmonic, the second a quarter cycle ahead."""
    average = coefficients.mean(axis=0)
    axes: list[np.ndarray] = []
    for harmonic, pair in enumerate(average.reshape(-1, 2, average.shape[-1])):
        scores, _, unit = np.linalg.svd(pair, full_matrices=False)
        anatomy = walker.markers if harmonic == 0 else ()
        turn = -1 if is_negative(unit[0].reshape(-1, 3), anatomy) else 1
        axes.append(np.stack([turn * unit[0], turn * np.linalg.det(scores) * unit[1]]))
    return ReferenceWalker(np.stack(axes), average, walker.form, walker.markers)


def _align(coefficients: np.ndarray, reference: ReferenceWalker) -> tuple[_Aligned, np.ndarray]:
    """Postures of all walkers rotated towards the average's, and by which angle clocks shift."""
    if reference.form == "fourier":
        fundamental = reference.average[:2]
        shifts = np.where(np.einsum("whf,hf->w", coefficients[:, :2], fundamental) < 0, np.pi, 0.0)
        postures = _shift_origins(coefficients, shifts)
        phases = np.tile([0.0, np.pi / 2], (len(postures), len(reference.axes)))
        return _Aligned(postures, phases, _cosines(postures, reference.average)), shifts
    unit, scores = _rotate_axes(coefficients, reference.axes)
    amplitudes = np.linalg.norm(scores, axis=-2).reshape(len(coefficients), -1)
    phases = np.arctan2(scores[..., 1, :], scores[..., 0, :]).reshape(len(coefficients), -1)
    postures = amplitudes[..., None] * unit.reshape(len(coefficients), -1, unit.shape[-1])
    shifts = -phases[:, 0]
    harmonics = np.repeat(np.arange(1, len(reference.axes) + 1), 2)
    phases = wrap_phase(phases + harmonics * shifts[:, None])
    similarity = _cosines(postures, reference.axes.reshape(-1, unit.shape[-1]))
    return _Aligned(postures, phases, similarity), shifts


def _rotate_axes(coefficients: np.ndarray, axes: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Each walker's unit eigenpostures, rotated towards the average's, and their scores."""
    pairs = coefficients.reshape(len(coefficients), -1, 2, coefficients.shape[-1])
    scores, amplitude, unit = np.linalg.svd(pairs, full_matrices=False)
    # Orthogonal Procrustes: the rotation of the axes that brings them nearest to the average's.
    left, _, right = np.linalg.svd(unit @ np.swapaxes(axes, -1, -2))
    turn = np.swapaxes(left @ right, -1, -2)
    return turn @ unit, (scores * amplitude[..., None, :]) @ np.swapaxes(turn, -1, -2)


def _cosines(postures: np.ndarray, others: np.ndarray) -> np.ndarray:
    lengths = np.linalg.norm(postures, axis=-1) * np.linalg.norm(others, axis=-1)
    products = np.einsum("wcf,cf->wc", postures, others)
    return products / np.where(lengths > 0, lengths, np.inf)


def _flags(aligned: _Aligned, reference: ReferenceWalker) -> tuple[str, ...]:
    """Why correspondence does not hold for each walker; empty where it does."""
    power = (aligned.postures**2).sum(axis=-1)
    counts = power > MIN_SHARE * power.sum(axis=1, keepdims=True)
    similarity = np.where(counts, aligned.similarity, 1.0)
    name = "eigenposture" if reference.form == "eigenposture" else "Fourier posture"
    return tuple(
        ""
        if row.min() >= MIN_SIMILARITY
        else f"No correspondence: {name} {row.argmin() + 1} and the average walker's have a cosine "
        f"of only {row.min():.2f}."
        for row in similarity
    )


def _with_postures(walker: Walker, aligned: _Aligned, number: int, clock: float) -> Walker:
    """Return the walker with its postures in correspondence, its clock shifted by an angle."""
    n_components: int = aligned.postures.shape[1]
    later_s = wrap_phase(np.array(clock)).item() / (2 * np.pi * walker.frequency_hz)
    fit = walker.fit
    if fit is not None:
        fit = replace(fit, fourier=shift_origin(fit.fourier, clock))
    return replace(
        walker,
        p=aligned.postures[number].reshape(n_components, -1, 3),
        harmonics=np.repeat(np.arange(1, n_components // 2 + 1), 2),
        phases=aligned.phases[number],
        time_origin_s=walker.time_origin_s + later_s,
        fit=fit,
    )
