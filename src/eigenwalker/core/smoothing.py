"""Extrema between samples, and running means."""

from __future__ import annotations


def parabola_vertex(before: float, here: float, after: float) -> tuple[float, float]:
    """Return the vertex of the parabola through three equally spaced samples.

    Parameters
    ----------
    before, here, after : float
        An extreme sample and its two neighbours.

    Returns
    -------
    shift : float
        Where the vertex is, in samples from the middle one.
    height : float
        The value there. On a straight line both are those of the middle sample.

    Examples
    --------
    >>> parabola_vertex(0.0, 3.0, 2.0)
    (0.25, 3.125)

    """
    curvature = before - 2 * here + after
    if curvature == 0:
        return 0.0, here
    return 0.5 * (before - after) / curvature, here - (before - after) ** 2 / (8 * curvature)
