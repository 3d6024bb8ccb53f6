from .captures import write_captures as write_captures
from .overground import Route as Route
from .people import (
    simulate_captures as simulate_captures,
    simulate_population as simulate_population,
)
from .person import PARAMETERS as PARAMETERS, average_person as average_person
from .planted_effect import Pattern as Pattern, plant as plant, random_pattern as random_pattern
from .provenance import CAPTURE as CAPTURE
from .trait_effects import EFFECTS as EFFECTS, TRAITS as TRAITS, draw_people as draw_people
from .truth import Truth as Truth, true_direction as true_direction, truth_of as truth_of
from .walk import FULL as FULL, simulate_walk as simulate_walk, true_events as true_events
