"""Trajectories and walkers -> files that other programs read: one format a file."""

from eigenwalker.writing.write import FORMATS, write_mocap

__all__ = ["FORMATS", "write_mocap"]
