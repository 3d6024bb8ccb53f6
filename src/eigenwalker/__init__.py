"""How people walk, and how people see others walk.

Captures of walking people in; a model of how they walk, classifiers, walkers of any trait out,
after Troje (2002). Import it as ``import eigenwalker as ew``; names load when first used.
"""

from __future__ import annotations

import importlib
from typing import TYPE_CHECKING

__version__ = "0.1.0"

_HOME = {
    "Skeleton": "skeleton",
    "JOINTS": "skeleton",
    "label_trajectories": "trajectories",
    "Walker": "walker",
}
"""Each public name and the module it lives in."""

__all__ = sorted(_HOME)

if TYPE_CHECKING:
    from eigenwalker.skeleton import JOINTS as JOINTS
    from eigenwalker.skeleton import Skeleton as Skeleton
    from eigenwalker.trajectories import label_trajectories as label_trajectories
    from eigenwalker.walker import Walker as Walker


def __getattr__(name: str) -> object:
    if name not in _HOME:
        raise AttributeError(f"module 'eigenwalker' has no attribute {name!r}")
    value = getattr(importlib.import_module(f"eigenwalker.{_HOME[name]}"), name)
    globals()[name] = value
    return value


def __dir__() -> list[str]:
    return sorted([*globals(), *_HOME])
