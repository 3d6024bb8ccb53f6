from .figure import Figure as Figure
from .html_page import stand_alone_page as stand_alone_page
from .make import make_stimulus as make_stimulus
from .schema import Display as Display, Timing as Timing, View as View
from .stimulus import Stimulus as Stimulus
from .walker_information import with_information as with_information
from .write_stimulus import write_stimulus as write_stimulus
