from .alignment import Alignment as Alignment
from .clip_distances import (
    Comparison as Comparison,
    clip_components as clip_components,
    clip_distance as clip_distance,
    compare_walks as compare_walks,
    step_distances as step_distances,
)
from .clips import Clip as Clip, Clips as Clips, Loop as Loop, PreparedClip as PreparedClip
from .comparison_pipeline import prepare_walk as prepare_walk
from .frame_metrics import (
    FrameMetric as FrameMetric,
    GroupMetric as GroupMetric,
    Metric as Metric,
    shaped as shaped,
)
from .group_tables import (
    collinear_groups as collinear_groups,
    group_table as group_table,
    missing_groups as missing_groups,
)
from .joint_angles import angle_between as angle_between, joint_quaternions as joint_quaternions
from .joint_groups import (
    BONES as BONES,
    GROUPS as GROUPS,
    group_points as group_points,
)
from .loops import loop as loop
from .motion_maps import motion_map as motion_map, motion_maps as motion_maps
from .neighbours import label_table as label_table, nearest_walks as nearest_walks
from .pairwise import (
    distances_by_metric as distances_by_metric,
    pair_components as pair_components,
    pair_distances as pair_distances,
    pair_table as pair_table,
)
from .prepared import prepare as prepare
from .published import (
    FIGURE_5 as FIGURE_5,
    PUBLISHED as PUBLISHED,
    PublishedFit as PublishedFit,
)
from .registration import (
    Registration as Registration,
    register as register,
    register_walks as register_walks,
)
from .retargeting import HEIGHT_MM as HEIGHT_MM, SHARES as SHARES, retarget as retarget
from .spline_warps import register_by_spline as register_by_spline
from .transitions import find_transitions as find_transitions
