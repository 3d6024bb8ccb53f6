from . import (
    analysis as analysis,
    core as core,
    datasets as datasets,
    decomposition as decomposition,
    experiment as experiment,
    explorer as explorer,
    gait as gait,
    io as io,
    markers as markers,
    metric as metric,
    plotting as plotting,
    population as population,
    psychophysics as psychophysics,
    quality as quality,
    report as report,
    simulation as simulation,
    stimulus as stimulus,
    study as study,
)
from ._version import __version__ as __version__
from .analysis import (
    DiscriminantClassifier as DiscriminantClassifier,
    DiscriminantRegressor as DiscriminantRegressor,
    WalkerSpace as WalkerSpace,
    classify as classify,
    direction as direction,
    jackknife_curves as jackknife_curves,
    regress as regress,
    trait_axis as trait_axis,
)
from .core import (
    JOINTS as JOINTS,
    Skeleton as Skeleton,
    Walker as Walker,
    label_trajectories as label_trajectories,
)
from .datasets import load_population as load_population, read_walkers_mat as read_walkers_mat
from .decomposition import decompose_fourier as decompose_fourier, decompose_pca as decompose_pca
from .explorer import show as show
from .gait import fundamental_frequency as fundamental_frequency, in_place as in_place
from .io import (
    UnreadableFile as UnreadableFile,
    read_mocap as read_mocap,
    write_mocap as write_mocap,
)
from .markers import virtual_markers as virtual_markers
from .metric import (
    clip_distance as clip_distance,
    loop as loop,
    motion_map as motion_map,
    register as register,
)
from .population import Population as Population
from .psychophysics import (
    PerceptualMetric as PerceptualMetric,
    agreement as agreement,
    crossed_logistic as crossed_logistic,
    difference_table as difference_table,
    fit_choice_model as fit_choice_model,
    mixed_anova as mixed_anova,
    psychometric as psychometric,
    scheffe as scheffe,
    sensitivity as sensitivity,
    spearman_critical as spearman_critical,
)
from .quality import assess as assess
from .simulation import simulate_population as simulate_population, simulate_walk as simulate_walk
from .stimulus import (
    Stimulus as Stimulus,
    make_stimulus as make_stimulus,
    write_stimulus as write_stimulus,
)
from .study import fit_folder as fit_folder
