from .label_repair import (
    Rebuilt as Rebuilt,
    Repair as Repair,
    repair_labels as repair_labels,
)
from .virtual_markers import virtual_markers as virtual_markers
