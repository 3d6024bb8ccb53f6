"""What labelling does to a capture, undone: sides that change places, markers that flicker."""

from eigenwalker.mending.mend import FLICKER as FLICKER
from eigenwalker.mending.mend import JUMPS as JUMPS
from eigenwalker.mending.mend import SWAPS as SWAPS
from eigenwalker.mending.mend import markers_of as markers_of
from eigenwalker.mending.mend import mend as mend
from eigenwalker.mending.mend import samples_of as samples_of
from eigenwalker.mending.mend import told as told
