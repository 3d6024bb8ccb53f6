"""Files of motion capture -> trajectories: one format a file, bad files refused in one way."""

from eigenwalker.mocap.joints import virtual_markers
from eigenwalker.mocap.rate import RateAssumed
from eigenwalker.mocap.read import FORMATS, explained_by, is_capture, read_mocap
from eigenwalker.mocap.unreadable import UnreadableFile
from eigenwalker.mocap.upright import UnitGuessed

__all__ = [
    "FORMATS",
    "RateAssumed",
    "UnitGuessed",
    "UnreadableFile",
    "explained_by",
    "is_capture",
    "read_mocap",
    "virtual_markers",
]
