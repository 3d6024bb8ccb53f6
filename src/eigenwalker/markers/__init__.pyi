from .label_repair import (
    Rebuilt as Rebuilt,
    Repair as Repair,
    repair_labels as repair_labels,
)
from .mapping import MarkerMapping as MarkerMapping, read_mapping as read_mapping
from .virtual_markers import virtual_markers as virtual_markers
