from .fourier import decompose_fourier as decompose_fourier
from .pca import decompose_pca as decompose_pca
from .walk_components import Eigenpostures as Eigenpostures, eigenpostures_of as eigenpostures_of
