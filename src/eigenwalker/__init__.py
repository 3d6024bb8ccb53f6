"""How people walk, and how people see others walk.

Captures of walking people in; a model of how they walk, classifiers, walkers of any trait out,
after Troje (2002). Import it as ``import eigenwalker as ew``; names load when first used.
"""

from __future__ import annotations

import importlib
from typing import TYPE_CHECKING

__version__ = "0.1.0"

_HOME = {
    "assess": "quality",
    "classify": "classification",
    "contrast": "contrasts",
    "decompose_fourier": "decomposition",
    "decompose_pca": "decomposition",
    "direction": "caricature",
    "DiscriminantClassifier": "discriminant",
    "DiscriminantRegressor": "discriminant",
    "draw_people": "simulation",
    "fetch_captures": "downloads",
    "figure_curves": "display.curves",
    "figure_eigenpostures": "display.eigenpostures",
    "figure_joints": "display.bodies",
    "figure_regression_curves": "display.curves",
    "figure_scores": "display.components",
    "figure_space": "display.populations",
    "figure_variance": "display.components",
    "figure_walkers": "display.bodies",
    "fit_folder": "study",
    "from_movement": "interchange",
    "from_pyomeca": "interchange",
    "fundamental_frequency": "gait",
    "gait_events": "gait",
    "gait_parameters": "gait",
    "in_place": "gait",
    "is_capture": "mocap",
    "jackknife_curves": "jackknife",
    "JOINTS": "skeleton",
    "label_trajectories": "trajectories",
    "load_population": "datasets",
    "make_stimulus": "stimulus",
    "mend": "mending",
    "nested_leave_one_out": "validation",
    "nested_regression": "validation",
    "Pattern": "simulation",
    "permutation_test": "validation",
    "plausibility": "extrapolation",
    "Population": "population",
    "project": "display.projection",
    "Quality": "quality",
    "random_pattern": "simulation",
    "RateAssumed": "mocap",
    "read_bml_axes": "bml",
    "read_mat": "mocap.mat",
    "read_mm": "walker_files",
    "read_mocap": "mocap",
    "read_walkers_mat": "walker_files",
    "regress": "classification",
    "regression_curves": "jackknife",
    "regression_permutation_test": "validation",
    "Route": "simulation",
    "simulate_captures": "simulation",
    "simulate_population": "simulation",
    "simulate_walk": "simulation",
    "Skeleton": "skeleton",
    "stance_speed": "gait",
    "stand_alone_page": "page",
    "Stimulus": "stimulus",
    "to_movement": "interchange",
    "to_pyomeca": "interchange",
    "trait_axis": "trait_axes",
    "true_direction": "simulation",
    "true_events": "simulation",
    "truth_of": "simulation",
    "UnitGuessed": "mocap",
    "UnreadableFile": "mocap",
    "virtual_markers": "mocap",
    "Walker": "walker",
    "walker_from_file": "attempts",
    "walker_from_mm": "walker_tables",
    "walker_from_table": "walker_tables",
    "walker_to_mm": "walker_tables",
    "walker_to_table": "walker_tables",
    "WalkerSpace": "space",
    "with_information": "stimulus.information",
    "write_captures": "simulation",
    "write_film": "display.films",
    "write_mocap": "writing",
    "write_report": "report.page",
    "write_stimulus": "stimulus.write",
}
"""Each public name and the module it lives in."""

__all__ = sorted(_HOME)

if TYPE_CHECKING:
    from eigenwalker.attempts import walker_from_file as walker_from_file
    from eigenwalker.bml import read_bml_axes as read_bml_axes
    from eigenwalker.caricature import direction as direction
    from eigenwalker.classification import classify as classify
    from eigenwalker.classification import regress as regress
    from eigenwalker.contrasts import contrast as contrast
    from eigenwalker.datasets import load_population as load_population
    from eigenwalker.decomposition import decompose_fourier as decompose_fourier
    from eigenwalker.decomposition import decompose_pca as decompose_pca
    from eigenwalker.discriminant import DiscriminantClassifier as DiscriminantClassifier
    from eigenwalker.discriminant import DiscriminantRegressor as DiscriminantRegressor
    from eigenwalker.display.bodies import figure_joints as figure_joints
    from eigenwalker.display.bodies import figure_walkers as figure_walkers
    from eigenwalker.display.components import figure_scores as figure_scores
    from eigenwalker.display.components import figure_variance as figure_variance
    from eigenwalker.display.curves import figure_curves as figure_curves
    from eigenwalker.display.curves import figure_regression_curves as figure_regression_curves
    from eigenwalker.display.eigenpostures import figure_eigenpostures as figure_eigenpostures
    from eigenwalker.display.films import write_film as write_film
    from eigenwalker.display.populations import figure_space as figure_space
    from eigenwalker.display.projection import project as project
    from eigenwalker.downloads import fetch_captures as fetch_captures
    from eigenwalker.extrapolation import plausibility as plausibility
    from eigenwalker.gait import fundamental_frequency as fundamental_frequency
    from eigenwalker.gait import gait_events as gait_events
    from eigenwalker.gait import gait_parameters as gait_parameters
    from eigenwalker.gait import in_place as in_place
    from eigenwalker.gait import stance_speed as stance_speed
    from eigenwalker.interchange import from_movement as from_movement
    from eigenwalker.interchange import from_pyomeca as from_pyomeca
    from eigenwalker.interchange import to_movement as to_movement
    from eigenwalker.interchange import to_pyomeca as to_pyomeca
    from eigenwalker.jackknife import jackknife_curves as jackknife_curves
    from eigenwalker.jackknife import regression_curves as regression_curves
    from eigenwalker.mending import mend as mend
    from eigenwalker.mocap import RateAssumed as RateAssumed
    from eigenwalker.mocap import UnitGuessed as UnitGuessed
    from eigenwalker.mocap import UnreadableFile as UnreadableFile
    from eigenwalker.mocap import is_capture as is_capture
    from eigenwalker.mocap import read_mocap as read_mocap
    from eigenwalker.mocap import virtual_markers as virtual_markers
    from eigenwalker.mocap.mat import read_mat as read_mat
    from eigenwalker.page import stand_alone_page as stand_alone_page
    from eigenwalker.population import Population as Population
    from eigenwalker.quality import Quality as Quality
    from eigenwalker.quality import assess as assess
    from eigenwalker.report.page import write_report as write_report
    from eigenwalker.simulation import Pattern as Pattern
    from eigenwalker.simulation import Route as Route
    from eigenwalker.simulation import draw_people as draw_people
    from eigenwalker.simulation import random_pattern as random_pattern
    from eigenwalker.simulation import simulate_captures as simulate_captures
    from eigenwalker.simulation import simulate_population as simulate_population
    from eigenwalker.simulation import simulate_walk as simulate_walk
    from eigenwalker.simulation import true_direction as true_direction
    from eigenwalker.simulation import true_events as true_events
    from eigenwalker.simulation import truth_of as truth_of
    from eigenwalker.simulation import write_captures as write_captures
    from eigenwalker.skeleton import JOINTS as JOINTS
    from eigenwalker.skeleton import Skeleton as Skeleton
    from eigenwalker.space import WalkerSpace as WalkerSpace
    from eigenwalker.stimulus import Stimulus as Stimulus
    from eigenwalker.stimulus import make_stimulus as make_stimulus
    from eigenwalker.stimulus.information import with_information as with_information
    from eigenwalker.stimulus.write import write_stimulus as write_stimulus
    from eigenwalker.study import fit_folder as fit_folder
    from eigenwalker.trait_axes import trait_axis as trait_axis
    from eigenwalker.trajectories import label_trajectories as label_trajectories
    from eigenwalker.validation import nested_leave_one_out as nested_leave_one_out
    from eigenwalker.validation import nested_regression as nested_regression
    from eigenwalker.validation import permutation_test as permutation_test
    from eigenwalker.validation import regression_permutation_test as regression_permutation_test
    from eigenwalker.walker import Walker as Walker
    from eigenwalker.walker_files import read_mm as read_mm
    from eigenwalker.walker_files import read_walkers_mat as read_walkers_mat
    from eigenwalker.walker_tables import walker_from_mm as walker_from_mm
    from eigenwalker.walker_tables import walker_from_table as walker_from_table
    from eigenwalker.walker_tables import walker_to_mm as walker_to_mm
    from eigenwalker.walker_tables import walker_to_table as walker_to_table
    from eigenwalker.writing import write_mocap as write_mocap


def __getattr__(name: str) -> object:
    if name not in _HOME:
        raise AttributeError(f"module 'eigenwalker' has no attribute {name!r}")
    value = getattr(importlib.import_module(f"eigenwalker.{_HOME[name]}"), name)
    globals()[name] = value
    return value


def __dir__() -> list[str]:
    return __all__
