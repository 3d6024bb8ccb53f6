from .figure import Figure as Figure
from .html_page import stand_alone_page as stand_alone_page
from .make import (
    Information as Information,
    make_stimulus as make_stimulus,
    with_information as with_information,
)
from .moving_dots import Moments as Moments, MovingDots as MovingDots
from .player import Played as Played
from .rig_choices import RigChoices as RigChoices
from .schema import (
    Display as Display,
    StimulusFile as StimulusFile,
    Style as Style,
    Timing as Timing,
    View as View,
)
from .stimulus import Stimulus as Stimulus
from .write_stimulus import write_stimulus as write_stimulus
