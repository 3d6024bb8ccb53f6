from .angles import angle_between as angle_between, joint_quaternions as joint_quaternions
from .clip_distances import (
    clip_components as clip_components,
    clip_distance as clip_distance,
    pair_components as pair_components,
    pair_distances as pair_distances,
    pair_table as pair_table,
    step_distances as step_distances,
)
from .comparison import Comparison as Comparison, compare_walks as compare_walks
from .comparison_pipeline import comparable_walk as comparable_walk
from .frame_metrics import ComparesFrames as ComparesFrames, FrameMetric as FrameMetric
from .group_tables import group_table as group_table
from .groups import group_points as group_points
from .loops import Loop as Loop, loop as loop
from .motion_maps import motion_map as motion_map, motion_maps as motion_maps
from .prepared import PreparedClip as PreparedClip, prepare as prepare
from .published import (
    PUBLISHED as PUBLISHED,
    GroupMetric as GroupMetric,
    metric_named as metric_named,
)
from .registration import (
    Registration as Registration,
    register as register,
    register_walks as register_walks,
)
from .retargeting import retarget as retarget
from .spline_warps import register_by_spline as register_by_spline
from .transitions import find_transitions as find_transitions
