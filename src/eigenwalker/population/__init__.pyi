from .correspondence import (
    Correspondence as Correspondence,
    ReferenceWalker as ReferenceWalker,
    correspond as correspond,
    correspond_to as correspond_to,
    match_sign_and_order as match_sign_and_order,
    posture_correlations as posture_correlations,
)
from .features import FeatureLayout as FeatureLayout
from .population import Population as Population
