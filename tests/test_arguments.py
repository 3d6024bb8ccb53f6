"""Every public function of every room refuses wrong arrays, walks and walkers in words of its own.

Functions are discovered from the rooms' lists of names, and what an argument has to be from its
annotation: a new function is tested too, or fails for want of a call that works.
"""

from __future__ import annotations

import ast
import importlib
import inspect
import traceback
import warnings
from functools import cache
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
import xarray as xr

import eigenwalker as ew

ROOT = Path(ew.__file__).parent
ROOMS = sorted(stub.parent.name for stub in ROOT.glob("*/__init__.pyi"))


@cache
def walk():
    return ew.simulate_walk(seed=1, duration_s=4, rate_hz=60)


@cache
def walkers():
    return tuple(
        ew.decompose_pca(ew.simulate_walk(seed=seed, duration_s=4, rate_hz=60)) for seed in range(4)
    )


@cache
def people():
    return ew.load_population()


@cache
def space():
    return ew.WalkerSpace(n_components=3).fit(people().X)


def numbers(*shape):
    return np.random.default_rng(0).uniform(1, 2, shape)


def labels(n=12):
    return np.where(np.arange(n) % 2, 1.0, -1.0)


@cache
def trials():
    rows = [["Eva", "a", "b", "c", "d", *pair] for pair in ("ab", "ac", "bd", "cd")]
    rows += [["Ida", "a", "b", "c", "e", *pair] for pair in ("ab", "ae", "ce")]
    columns = ["observer", *"abcd", "chosen_1", "chosen_2"]
    return pd.DataFrame(rows, columns=columns)


def read_trials():
    return ew.psychophysics.read_trials(trials())


PAIRS = [(a, b) for i, a in enumerate("abcde") for b in "abcde"[i + 1 :]]


def distance_table():
    place = numbers(5)
    return np.abs(place[:, None] - place)


def clips():
    return {"a": walk(), "b": walk() * 1.01}


def registration_map():
    return ew.metric.motion_map(walk().isel(time=slice(0, 20)))


CALLS = {
    "analysis.classify": lambda: {"population": people(), "trait": "sex", "inputs": ()},
    "analysis.direction": None,
    "analysis.jackknife_curves": lambda: {"X": numbers(12, 3), "y": labels()},
    "analysis.nested_leave_one_out": lambda: {"X": numbers(12, 3), "y": labels()},
    "analysis.permutation_test": lambda: {
        "X": numbers(12, 3), "y": labels(), "n_permutations": 3
    },
    "analysis.plausibility": lambda: {"population": people(), "vector": people().X[0]},
    "analysis.position_in_space": lambda: {
        "space": space(), "vector": people().X[0], "walkers": people().X
    },
    "analysis.regress": None,
    "analysis.regression_curves": lambda: {"X": numbers(12, 3), "y": numbers(12)},
    "analysis.study_trait": None,
    "analysis.trait_axis": lambda: {"population": people(), "trait": "sex"},
    "analysis.trait_contrast": lambda: {"population": people(), "trait": "sex"},
    "core.fourier_coefficients": lambda: {"walker": walkers()[0], "n_harmonics": 2},
    "core.harmonic_basis": lambda: {"cycles": numbers(20), "n_harmonics": 2},
    "core.label_trajectories": lambda: {
        "values": numbers(5, 2, 3), "markers": ["head", "pelvis"], "rate_hz": 100
    },
    "core.share_explained": lambda: {"movement": numbers(20, 3), "cycles": np.arange(20) / 10},
    "core.shift_origin": lambda: {"coefficients": numbers(4, 2, 3), "angle": 0.5},
    "datasets.fetch_captures": None,
    "datasets.load_population": None,
    "datasets.read_bml_axes": None,
    "datasets.read_mm": None,
    "datasets.read_walkers_mat": None,
    "decomposition.decompose_fourier": lambda: {"walk": walk()},
    "decomposition.decompose_pca": lambda: {"walk": walk()},
    "decomposition.eigenpostures_of": lambda: {
        "postures": walk().values.reshape(len(walk()), -1), "rate_hz": 60.0
    },
}
