"""Point-light stimuli: figures, transforms in a chain, one file that Python and a page play alike.

Made with `make_stimulus`, changed with `Stimulus.then`.
"""

from eigenwalker.stimulus.figure import Figure as Figure
from eigenwalker.stimulus.making import make_stimulus as make_stimulus
from eigenwalker.stimulus.stimulus import Display as Display
from eigenwalker.stimulus.stimulus import Stimulus as Stimulus
from eigenwalker.stimulus.stimulus import Timing as Timing
from eigenwalker.stimulus.stimulus import View as View
