from .agreement import Agreement as Agreement, agreement as agreement
from .choice_model import ChoiceModel as ChoiceModel, fit_choice_model as fit_choice_model
from .conditional_logit import (
    ChoiceFit as ChoiceFit,
    bootstrap_choices as bootstrap_choices,
    expected_differences as expected_differences,
    fit_choices as fit_choices,
)
from .cross_validation import (
    compare_by_choices as compare_by_choices,
    compare_metrics as compare_metrics,
    goodness as goodness,
    leave_walkers_out as leave_walkers_out,
    left_out_differences as left_out_differences,
)
from .crossed_logistic import (
    CrossedLogistic as CrossedLogistic,
    CrossedModel as CrossedModel,
    crossed_logistic as crossed_logistic,
)
from .difference_table import (
    TriangleInequalities as TriangleInequalities,
    difference_table as difference_table,
    triangle_inequalities as triangle_inequalities,
)
from .dissimilarity_structure import (
    cluster_memberships as cluster_memberships,
    clusters_of_walks as clusters_of_walks,
    map_of_walks as map_of_walks,
    order_of_walks as order_of_walks,
)
from .error_rates import condition_means as condition_means, error_rates as error_rates
from .fit_to_answers import MetricFit as MetricFit, fit_to_answers as fit_to_answers
from .item_analysis import (
    confidence_correlations as confidence_correlations,
    walker_errors as walker_errors,
)
from .mixed_anova import mixed_anova as mixed_anova
from .paired_t import paired_t as paired_t
from .perceptual_metric import (
    PerceptualMetric as PerceptualMetric,
    Weights as Weights,
    non_negative_fit as non_negative_fit,
)
from .psychometric import PsychometricFits as PsychometricFits, psychometric as psychometric
from .rank_correlation import (
    RankCorrelation as RankCorrelation,
    rank_correlation as rank_correlation,
    spearman_critical as spearman_critical,
)
from .reliability import (
    Bootstrap as Bootstrap,
    Reliability as Reliability,
    bootstrap_weights as bootstrap_weights,
    split_half as split_half,
)
from .scheffe import scheffe as scheffe
from .sensitivity import sensitivity as sensitivity
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
    read_answers as read_answers,
    read_trials as read_trials,
)
from .weights_file import load_metric as load_metric, save_weights as save_weights
