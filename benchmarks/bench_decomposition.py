"""Decomposition of walks: eigenpostures and the sines they ride on.

Beside what one would reach for: scikit-learn's PCA, and a sine fitted to each of four scores by
scipy's curve_fit, started at the peak of its spectrum.
"""

from __future__ import annotations

import numpy as np
import xarray as xr
from scipy.optimize import curve_fit
from side_by_side import machine, print_table, seconds
from sklearn.decomposition import PCA

import eigenwalker as ew
from eigenwalker.decomposition import decompose_pca, eigenpostures_of

N_WALKERS, N_FRAMES, RATE_HZ = 40, 1400, 120.0
HARMONICS = np.array([1, 1, 2, 2])


def walks() -> list[xr.DataArray]:
    """Twelve seconds of four postures that ride on sines, with a millimetre of noise."""
    rng = np.random.default_rng(0)
    time = np.arange(N_FRAMES) / RATE_HZ
    made = []
    for _ in range(N_WALKERS):
        postures = np.linalg.qr(rng.normal(size=(45, 4)))[0].T
        postures *= np.array([[600.0], [250.0], [120.0], [60.0]])
        phases = [0, np.pi / 2, 1, 1 + np.pi / 2]
        cycle = 2 * np.pi * rng.normal(0.85, 0.07) * time[:, None]
        values = np.sin(HARMONICS * cycle + phases) @ postures + 1000 * rng.normal(size=45)
        values += rng.normal(size=values.shape)
        made.append(
            ew.label_trajectories(
                values.reshape(N_FRAMES, 15, 3), markers=ew.JOINTS.markers, rate_hz=RATE_HZ
            )
        )
    return made


def sine(
    time: np.ndarray, amplitude: float, frequency: float, phase: float, offset: float = 0
) -> np.ndarray:
    return amplitude * np.sin(2 * np.pi * frequency * time + phase) + offset


def peer(postures: np.ndarray, *, offset: bool = False) -> tuple[np.ndarray, np.ndarray]:
    """Components, and the frequency of each score.

    Started at the peak of a spectrum without padding, 6 of the 160 fits end at a wrong frequency.
    """
    pca = PCA(4)
    scores = pca.fit_transform(postures)
    time = np.arange(len(postures)) / RATE_HZ
    n_padded = 4 * len(postures)
    found = []
    for score in scores.T:
        peak_hz = np.abs(np.fft.rfft(score, n_padded)).argmax() * RATE_HZ / n_padded
        start = [np.sqrt(2) * score.std(), peak_hz, 0.0] + [0.0] * offset
        found.append(curve_fit(sine, time, score, p0=start)[0][1])
    return pca.components_, np.array(found)


def assert_same_answers(captures: list[xr.DataArray], arrays: list[np.ndarray]) -> None:
    for capture, postures in zip(captures, arrays, strict=True):
        components, frequencies = peer(postures)
        found = eigenpostures_of(postures, RATE_HZ)
        walker = decompose_pca(capture)
        agreement = np.abs(np.sum(components * found.components, axis=1))
        np.testing.assert_allclose(agreement, 1, atol=1e-9)
        np.testing.assert_allclose(frequencies / HARMONICS, found.frequency_hz, atol=1e-3)
        assert abs(walker.frequency_hz - found.frequency_hz) < 1e-12


if __name__ == "__main__":
    captures = walks()
    arrays = [walk.values.reshape(N_FRAMES, -1) for walk in captures]
    assert_same_answers(captures, arrays)
    times = seconds(
        {
            "PCA(4) and 4 x curve_fit": lambda: [peer(each) for each in arrays],
            "the same, fitting offsets as ours does": lambda: [
                peer(each, offset=True) for each in arrays
            ],
            "eigenpostures_of": lambda: [eigenpostures_of(each, RATE_HZ) for each in arrays],
            "decompose_pca": lambda: [decompose_pca(walk) for walk in captures],
        },
        rounds=9,
    )
    print(f"Decomposition ({machine()})")
    title = f"{N_WALKERS} walks of {N_FRAMES} frames, 15 joints"
    print_table(title, times, aims={"eigenpostures_of": 7, "decompose_pca": 3})
