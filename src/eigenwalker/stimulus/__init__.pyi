from .figure import Figure as Figure
from .html_page import stand_alone_page as stand_alone_page
from .make import make_stimulus as make_stimulus
from .player import Played as Played
from .stimulus import Display as Display, Stimulus as Stimulus, Timing as Timing, View as View
from .walker_information import with_information as with_information
from .write_stimulus import write_stimulus as write_stimulus
