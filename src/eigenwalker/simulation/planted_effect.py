"""Effects added to what a walk is described by, not to the body that walks.

In a jointed body breadth also scales movement, so an effect set through the body reaches structure
and dynamics alike. One added here moves the mean posture alone, or the movement alone: what a
classifier of the other must not see.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Literal

import numpy as np
import xarray as xr

from eigenwalker.core.arguments import check_choice, check_numbers, generator
from eigenwalker.core.fourier import harmonic_basis
from eigenwalker.core.skeleton import JOINTS
from eigenwalker.core.trajectories import check_trajectories

_N_JOINTS = len(JOINTS.markers)


@dataclass(frozen=True)
class PlantedEffect:
    r"""What one unit of a trait adds to a walk of the 15 joints.

    .. math:: \Delta p(\phi) = s + m_1 \cos 2 \pi \phi + m_2 \sin 2 \pi \phi
              + m_3 \cos 4 \pi \phi + m_4 \sin 4 \pi \phi

    with s the structure, m the movement, and the phase :math:`\phi` in strides.

    Parameters
    ----------
    structure : array of shape (marker, axis)
        Added to the mean posture, in millimetres.
    movement : array of shape (4, marker, axis)
        Added to the coefficients of cos 1, sin 1, cos 2 and sin 2 over the stride, in millimetres.
    frequency_hz : float
        Added to the stride frequency.

    See Also
    --------
    random_effect : one of random directions.
    simulate_population : plants effects.
    """

    structure: np.ndarray = field(default_factory=lambda: np.zeros((_N_JOINTS, 3)))
    movement: np.ndarray = field(default_factory=lambda: np.zeros((4, _N_JOINTS, 3)))
    frequency_hz: float = 0.0

    def __post_init__(self) -> None:
        for name in ("structure", "movement"):
            object.__setattr__(self, name, check_numbers(getattr(self, name), name))
        shapes = np.shape(self.structure), np.shape(self.movement)
        if shapes != ((_N_JOINTS, 3), (4, _N_JOINTS, 3)):
            raise ValueError(
                f"An effect has a structure of shape {(_N_JOINTS, 3)} and a movement of shape "
                f"{(4, _N_JOINTS, 3)}; got {shapes[0]} and {shapes[1]}."
            )


def random_effect(
    part: Literal["structure", "dynamics"], *, size_mm: float, seed: int = 0
) -> PlantedEffect:
    """Return an effect of random directions, all in one part of a walk.

    Parameters
    ----------
    part : {"structure", "dynamics"}
        The mean posture, or the movement about it. Ankles are not moved up and down: where they
        stand is where `in_place` finds the floor, from which the mean posture is measured.
    size_mm : float
        Root mean square of what one unit of the trait adds to each coordinate.
    seed : int
        The same seed gives the same effect.

    Returns
    -------
    PlantedEffect

    See Also
    --------
    add_effect : adds it to a walk.

    Examples
    --------
    >>> effect = random_effect("structure", size_mm=5, seed=1)
    >>> bool(effect.structure.any()), bool(effect.movement.any())
    (True, False)
    """
    check_choice(part, ("structure", "dynamics"), "part")
    rng = generator(seed, "seed", 77)
    shape = (_N_JOINTS, 3) if part == "structure" else (4, _N_JOINTS, 3)
    direction = rng.standard_normal(shape)
    direction[..., [JOINTS.index(f"{side}_ankle") for side in ("left", "right")], 2] = 0
    direction *= size_mm / np.sqrt(np.mean(direction**2))
    return PlantedEffect(**{"structure" if part == "structure" else "movement": direction})


def add_effect(walk: xr.DataArray, effect: PlantedEffect, amount: float) -> xr.DataArray:
    """Return a simulated walk of the 15 joints with an effect added, so many times.

    The stride frequency is a matter of the person, not of the trajectories: see
    `simulate_captures`.

    Parameters
    ----------
    walk : DataArray of shape (time, marker, axis)
        As `simulate_walk` returns it, with the coordinate ``phase``.
    effect : PlantedEffect
    amount : float
        Units of the trait.

    Returns
    -------
    DataArray of shape (time, marker, axis)
        Millimetres.

    Raises
    ------
    ValueError
        If the walk is not of the 15 joints.

    See Also
    --------
    simulate_population : plants effects in many.

    Examples
    --------
    >>> walk = ew.simulate_walk(seed=1)
    >>> lower = PlantedEffect(structure=np.full((15, 3), [0.0, 0.0, -10.0]))
    >>> round(float((add_effect(walk, lower, 2.0) - walk).min()))
    -20
    """
    walk = check_trajectories(walk)
    if tuple(walk["marker"].values) != JOINTS.markers:
        raise ValueError("Effects are of the 15 joints; simulate the walk with markers='joints'.")
    waves = harmonic_basis(walk["phase"].values, 2)[:, [2, 1, 4, 3]]
    added = effect.structure + np.tensordot(waves, effect.movement, axes=1)
    return walk.copy(data=walk.values + amount * added)
