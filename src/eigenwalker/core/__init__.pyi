from .skeleton import JOINTS as JOINTS, Skeleton as Skeleton
from .trajectories import label_trajectories as label_trajectories
from .walker import Walker as Walker
