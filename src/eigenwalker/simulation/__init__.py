"""Walks and populations with known truth: a jointed body on published norms."""

from eigenwalker.simulation.overground import Route
from eigenwalker.simulation.parameters import PARAMETERS, average_person
from eigenwalker.simulation.people import simulate_captures, simulate_population
from eigenwalker.simulation.planting import Pattern, plant, random_pattern
from eigenwalker.simulation.recipe import CAPTURE
from eigenwalker.simulation.traits import EFFECTS, TRAITS, draw_people
from eigenwalker.simulation.truth import Truth, true_direction, truth_of
from eigenwalker.simulation.walking import FULL, simulate_walk, true_events
from eigenwalker.simulation.writing import write_captures

__all__ = [
    "CAPTURE",
    "EFFECTS",
    "FULL",
    "PARAMETERS",
    "TRAITS",
    "Pattern",
    "Route",
    "Truth",
    "average_person",
    "draw_people",
    "plant",
    "random_pattern",
    "simulate_captures",
    "simulate_population",
    "simulate_walk",
    "true_direction",
    "true_events",
    "truth_of",
    "write_captures",
]
