from .capture_file import RateAssumed as RateAssumed
from .errors import UnreadableFile as UnreadableFile
from .interchange import (
    from_movement as from_movement,
    from_pyomeca as from_pyomeca,
    to_movement as to_movement,
    to_pyomeca as to_pyomeca,
)
from .read import is_capture as is_capture, read_mocap as read_mocap
from .readers.mat import read_mat as read_mat
from .up_axis_and_unit import UnitGuessed as UnitGuessed, UpAxisAssumed as UpAxisAssumed
from .walker_tables import (
    COS_FIRST as COS_FIRST,
    SIN_FIRST as SIN_FIRST,
    walker_from_mm as walker_from_mm,
    walker_from_table as walker_from_table,
    walker_to_mm as walker_to_mm,
    walker_to_table as walker_to_table,
)
from .write import write_mocap as write_mocap
from .writers.bvh import constant_bones as constant_bones
