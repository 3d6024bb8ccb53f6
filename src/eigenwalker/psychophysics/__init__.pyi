from .choice_prediction import (
    compare_by_choices as compare_by_choices,
    unseen_differences as unseen_differences,
)
from .conditional_logit import (
    ChoiceFit as ChoiceFit,
    bootstrap_choices as bootstrap_choices,
    expected_differences as expected_differences,
    fit_choices as fit_choices,
)
from .cross_validation import (
    compare_metrics as compare_metrics,
    leave_walkers_out as leave_walkers_out,
)
from .dissimilarity_structure import (
    clusters_of_walks as clusters_of_walks,
    map_of_walks as map_of_walks,
    order_of_walks as order_of_walks,
)
from .perceptual_metric import PerceptualMetric as PerceptualMetric
from .reliability import (
    Bootstrap as Bootstrap,
    Reliability as Reliability,
    bootstrap_weights as bootstrap_weights,
    split_half as split_half,
)
from .shape_search import (
    RandomStarts as RandomStarts,
    ShapeFit as ShapeFit,
    fit_from_random_starts as fit_from_random_starts,
    search_shape as search_shape,
)
from .trials import (
    PairCounts as PairCounts,
    Trials as Trials,
    count_pairs as count_pairs,
    read_trials as read_trials,
)
