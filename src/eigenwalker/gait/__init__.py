"""From a capture to a steady walk in place: frequency, gaps, steady strides, heading, events."""

from eigenwalker.gait.events import gait_events as gait_events
from eigenwalker.gait.frequency import frequency_of_scores as frequency_of_scores
from eigenwalker.gait.frequency import fundamental_frequency as fundamental_frequency
from eigenwalker.gait.heading import stance_speed as stance_speed
from eigenwalker.gait.parameters import gait_parameters as gait_parameters
from eigenwalker.gait.placement import in_place as in_place
