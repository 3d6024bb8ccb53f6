"""How a figure is written for animation programs."""

from __future__ import annotations

from typing import NamedTuple


class RigChoices(NamedTuple):
    """How a figure is written for animation programs.

    Parameters
    ----------
    skeleton : {"plain", "mixamo", "unreal", "unity"}
        Whose names and hierarchy the bones have.
    rest_pose : {"t", "a"}
        Arms at rest.
    in_place : bool
        Whether it walks on the spot; else it travels at a constant speed.
    unit : {"cm", "m"}, optional
        Of lengths; left out, cm in BVH and m in GLB.
    up : {"y", "z"}
        Axis that points up, in BVH.

    See Also
    --------
    eigenwalker.write_stimulus : Takes them.
    """

    skeleton: str = "plain"
    rest_pose: str = "t"
    in_place: bool = False
    unit: str | None = None
    up: str = "y"
