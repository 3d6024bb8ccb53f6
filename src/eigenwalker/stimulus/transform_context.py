"""What a transform may know beside its figure."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np


class Stage(NamedTuple):
    """Where a figure is shown.

    Parameters
    ----------
    observer : array of shape (3, 3)
        The observer's right, up, and the way to the observer, in the figure's own frame.
    figure : int
        Number of the figure, from 0: figures of one scene draw different random numbers.

    """

    observer: np.ndarray
    figure: int
