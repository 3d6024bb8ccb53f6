"""How people walk, and how people see others walk.

Captures of walking people in; a model of how they walk, classifiers, walkers of any trait out,
after Troje (2002). Import it as ``import eigenwalker as ew``; names load when first used.
"""

from __future__ import annotations

import importlib
from typing import TYPE_CHECKING

__version__ = "0.1.0"

_HOME = {
    "Comparison": "metric.comparison",
    "DiscriminantClassifier": "discriminant",
    "DiscriminantRegressor": "discriminant",
    "FrameMetric": "metric.frame_metrics",
    "GroupMetric": "metric.published",
    "JOINTS": "skeleton",
    "Loop": "metric.loops",
    "PUBLISHED": "metric.published",
    "Pattern": "simulation",
    "PerceptualMetric": "metric.perceptual",
    "Population": "population",
    "Quality": "quality",
    "RateAssumed": "mocap",
    "Registration": "metric.registration",
    "Route": "simulation",
    "Skeleton": "skeleton",
    "Stimulus": "stimulus",
    "Trials": "metric.answers",
    "UnitGuessed": "mocap",
    "UnreadableFile": "mocap",
    "Walker": "walker",
    "WalkerSpace": "space",
    "WalkerWidget": "widget",
    "angle_between": "metric.angles",
    "assess": "quality",
    "bootstrap_choices": "metric.choices",
    "bootstrap_weights": "metric.observers",
    "classify": "classification",
    "clip_components": "metric.clip_distances",
    "clip_distance": "metric.clip_distances",
    "clusters_of_walks": "metric.difference_structure",
    "comparable_walk": "metric.comparable",
    "compare_by_choices": "metric.foretold",
    "compare_metrics": "metric.fit_quality",
    "compare_walks": "metric.comparison",
    "contrast": "contrasts",
    "count_pairs": "metric.answers",
    "decompose_fourier": "decomposition",
    "decompose_pca": "decomposition",
    "direction": "caricature",
    "draw_people": "simulation",
    "expected_differences": "metric.choices",
    "fetch_captures": "downloads",
    "figure_curves": "display.curves",
    "figure_eigenpostures": "display.eigenpostures",
    "figure_joints": "display.bodies",
    "figure_maps": "display.difference_maps",
    "figure_regression_curves": "display.curves",
    "figure_scores": "display.components",
    "figure_space": "display.populations",
    "figure_two_walks": "display.difference_maps",
    "figure_variance": "display.components",
    "figure_walkers": "display.bodies",
    "find_transitions": "metric.transitions",
    "fit_choices": "metric.choices",
    "fit_folder": "study",
    "fit_from_random_starts": "metric.outer_search",
    "from_movement": "interchange",
    "from_pyomeca": "interchange",
    "fundamental_frequency": "gait",
    "gait_events": "gait",
    "gait_parameters": "gait",
    "group_points": "metric.groups",
    "group_table": "metric.group_tables",
    "in_place": "gait",
    "interactive_page": "page.interactive",
    "is_capture": "mocap",
    "jackknife_curves": "jackknife",
    "joint_quaternions": "metric.angles",
    "label_trajectories": "trajectories",
    "leave_walkers_out": "metric.fit_quality",
    "load_population": "datasets",
    "loop": "metric.loops",
    "make_stimulus": "stimulus",
    "map_of_walks": "metric.difference_structure",
    "mend": "mending",
    "metric_named": "metric.published",
    "motion_map": "metric.motion_maps",
    "motion_maps": "metric.motion_maps",
    "nested_leave_one_out": "validation",
    "nested_regression": "validation",
    "order_of_walks": "metric.difference_structure",
    "page_model": "page.model",
    "pair_components": "metric.clip_distances",
    "pair_distances": "metric.clip_distances",
    "pair_table": "metric.clip_distances",
    "permutation_test": "validation",
    "plausibility": "extrapolation",
    "prepare": "metric.prepared",
    "project": "display.projection",
    "random_pattern": "simulation",
    "read_bml_axes": "bml",
    "read_mat": "mocap.mat",
    "read_mm": "walker_files",
    "read_mocap": "mocap",
    "read_trials": "metric.answers",
    "read_walkers_mat": "walker_files",
    "register": "metric.registration",
    "register_by_spline": "metric.spline_warps",
    "register_walks": "metric.registration",
    "regress": "classification",
    "regression_curves": "jackknife",
    "regression_permutation_test": "validation",
    "retarget": "metric.retargeting",
    "search_shape": "metric.outer_search",
    "show": "widget",
    "simulate_captures": "simulation",
    "simulate_population": "simulation",
    "simulate_walk": "simulation",
    "split_half": "metric.observers",
    "stance_speed": "gait",
    "stand_alone_page": "page",
    "step_distances": "metric.clip_distances",
    "to_movement": "interchange",
    "to_pyomeca": "interchange",
    "trait_axis": "trait_axes",
    "true_direction": "simulation",
    "true_events": "simulation",
    "truth_of": "simulation",
    "unseen_differences": "metric.foretold",
    "virtual_markers": "mocap",
    "walker_from_file": "attempts",
    "walker_from_mm": "walker_tables",
    "walker_from_table": "walker_tables",
    "walker_measures": "measures",
    "walker_to_mm": "walker_tables",
    "walker_to_table": "walker_tables",
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
    from eigenwalker.display.difference_maps import figure_maps as figure_maps
    from eigenwalker.display.difference_maps import figure_two_walks as figure_two_walks
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
    from eigenwalker.measures import walker_measures as walker_measures
    from eigenwalker.mending import mend as mend
    from eigenwalker.metric.angles import angle_between as angle_between
    from eigenwalker.metric.angles import joint_quaternions as joint_quaternions
    from eigenwalker.metric.answers import Trials as Trials
    from eigenwalker.metric.answers import count_pairs as count_pairs
    from eigenwalker.metric.answers import read_trials as read_trials
    from eigenwalker.metric.choices import bootstrap_choices as bootstrap_choices
    from eigenwalker.metric.choices import expected_differences as expected_differences
    from eigenwalker.metric.choices import fit_choices as fit_choices
    from eigenwalker.metric.clip_distances import clip_components as clip_components
    from eigenwalker.metric.clip_distances import clip_distance as clip_distance
    from eigenwalker.metric.clip_distances import pair_components as pair_components
    from eigenwalker.metric.clip_distances import pair_distances as pair_distances
    from eigenwalker.metric.clip_distances import pair_table as pair_table
    from eigenwalker.metric.clip_distances import step_distances as step_distances
    from eigenwalker.metric.comparable import comparable_walk as comparable_walk
    from eigenwalker.metric.comparison import Comparison as Comparison
    from eigenwalker.metric.comparison import compare_walks as compare_walks
    from eigenwalker.metric.difference_structure import clusters_of_walks as clusters_of_walks
    from eigenwalker.metric.difference_structure import map_of_walks as map_of_walks
    from eigenwalker.metric.difference_structure import order_of_walks as order_of_walks
    from eigenwalker.metric.fit_quality import compare_metrics as compare_metrics
    from eigenwalker.metric.fit_quality import leave_walkers_out as leave_walkers_out
    from eigenwalker.metric.foretold import compare_by_choices as compare_by_choices
    from eigenwalker.metric.foretold import unseen_differences as unseen_differences
    from eigenwalker.metric.frame_metrics import FrameMetric as FrameMetric
    from eigenwalker.metric.group_tables import group_table as group_table
    from eigenwalker.metric.groups import group_points as group_points
    from eigenwalker.metric.loops import Loop as Loop
    from eigenwalker.metric.loops import loop as loop
    from eigenwalker.metric.motion_maps import motion_map as motion_map
    from eigenwalker.metric.motion_maps import motion_maps as motion_maps
    from eigenwalker.metric.observers import bootstrap_weights as bootstrap_weights
    from eigenwalker.metric.observers import split_half as split_half
    from eigenwalker.metric.outer_search import fit_from_random_starts as fit_from_random_starts
    from eigenwalker.metric.outer_search import search_shape as search_shape
    from eigenwalker.metric.perceptual import PerceptualMetric as PerceptualMetric
    from eigenwalker.metric.prepared import prepare as prepare
    from eigenwalker.metric.published import PUBLISHED as PUBLISHED
    from eigenwalker.metric.published import GroupMetric as GroupMetric
    from eigenwalker.metric.published import metric_named as metric_named
    from eigenwalker.metric.registration import Registration as Registration
    from eigenwalker.metric.registration import register as register
    from eigenwalker.metric.registration import register_walks as register_walks
    from eigenwalker.metric.retargeting import retarget as retarget
    from eigenwalker.metric.spline_warps import register_by_spline as register_by_spline
    from eigenwalker.metric.transitions import find_transitions as find_transitions
    from eigenwalker.mocap import RateAssumed as RateAssumed
    from eigenwalker.mocap import UnitGuessed as UnitGuessed
    from eigenwalker.mocap import UnreadableFile as UnreadableFile
    from eigenwalker.mocap import is_capture as is_capture
    from eigenwalker.mocap import read_mocap as read_mocap
    from eigenwalker.mocap import virtual_markers as virtual_markers
    from eigenwalker.mocap.mat import read_mat as read_mat
    from eigenwalker.page import stand_alone_page as stand_alone_page
    from eigenwalker.page.interactive import interactive_page as interactive_page
    from eigenwalker.page.model import page_model as page_model
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
    from eigenwalker.widget import WalkerWidget as WalkerWidget
    from eigenwalker.widget import show as show
    from eigenwalker.writing import write_mocap as write_mocap


def __getattr__(name: str) -> object:
    if name not in _HOME:
        raise AttributeError(f"module 'eigenwalker' has no attribute {name!r}")
    value = getattr(importlib.import_module(f"eigenwalker.{_HOME[name]}"), name)
    globals()[name] = value
    return value


def __dir__() -> list[str]:
    return __all__
