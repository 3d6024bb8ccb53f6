"""Walks and populations with known truth: a jointed body on published norms."""

from eigenwalker.simulation.people import simulate_captures, simulate_population
from eigenwalker.simulation.traits import EFFECTS, PARAMETERS, TRAITS, draw_people
from eigenwalker.simulation.walking import simulate_walk

__all__ = [
    "EFFECTS",
    "PARAMETERS",
    "TRAITS",
    "draw_people",
    "simulate_captures",
    "simulate_population",
    "simulate_walk",
]
