from .appearance import walker_measures as walker_measures
from .events import gait_events as gait_events
from .frequency import (
    NoStrideError as NoStrideError,
    frequency_of_scores as frequency_of_scores,
    fundamental_frequency as fundamental_frequency,
)
from .heading import ground_speed as ground_speed, stance_speed as stance_speed
from .in_place import in_place as in_place
from .parameters import gait_parameters as gait_parameters
