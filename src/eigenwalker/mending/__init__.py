"""What labelling does to a capture, undone: sides that change places, markers that flicker."""

from eigenwalker.mending.mend import markers_of as markers_of
from eigenwalker.mending.mend import mend as mend
