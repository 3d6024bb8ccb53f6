from .bml import BmlModel as BmlModel, read_bml_axes as read_bml_axes
from .built_in import load_population as load_population
from .citations import bibtex as bibtex
from .downloads import fetch_captures as fetch_captures
from .moler import read_mm as read_mm, read_walkers_mat as read_walkers_mat
