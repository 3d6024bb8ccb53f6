from .fourier import (
    harmonic_basis as harmonic_basis,
    share_explained as share_explained,
    shift_origin as shift_origin,
)
from .skeleton import JOINTS as JOINTS, Skeleton as Skeleton
from .trajectories import label_trajectories as label_trajectories
from .walker import (
    CaptureFit as CaptureFit,
    Walker as Walker,
    fourier_coefficients as fourier_coefficients,
)
