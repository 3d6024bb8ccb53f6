from .body import TOE_BEND as TOE_BEND
from .norms import norm_coefficients as norm_coefficients
from .overground import Route as Route
from .people import (
    simulate_captures as simulate_captures,
    simulate_population as simulate_population,
    write_captures as write_captures,
)
from .person import (
    PARAMETERS as PARAMETERS,
    Parameter as Parameter,
    average_person as average_person,
)
from .planted_effect import (
    PlantedEffect as PlantedEffect,
    add_effect as add_effect,
    random_effect as random_effect,
)
from .provenance import CAPTURE as CAPTURE
from .trait_effects import EFFECTS as EFFECTS, TRAITS as TRAITS, draw_people as draw_people
from .truth import Truth as Truth, true_direction as true_direction, truth_of as truth_of
from .walk import FULL as FULL, simulate_walk as simulate_walk, true_events as true_events
