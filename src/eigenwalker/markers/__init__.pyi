from .label_repair import mend as mend
from .virtual_markers import virtual_markers as virtual_markers
