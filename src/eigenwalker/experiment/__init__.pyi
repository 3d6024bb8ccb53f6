from .design import Design as Design
from .design_file import read_design as read_design
from .order import session_trials as session_trials
