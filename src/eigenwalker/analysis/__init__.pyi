from .classification import (
    INPUTS as INPUTS,
    N_PANELS as N_PANELS,
    Classification as Classification,
    Input as Input,
    InputResult as InputResult,
    Regression as Regression,
    classify as classify,
    regress as regress,
)
from .contrast import Contrast as Contrast, trait_contrast as trait_contrast
from .direction import direction as direction
from .discriminant import (
    DiscriminantClassifier as DiscriminantClassifier,
    DiscriminantRegressor as DiscriminantRegressor,
)
from .jackknife import (
    JackknifeCurves as JackknifeCurves,
    RegressionCurves as RegressionCurves,
    jackknife_curves as jackknife_curves,
    regression_curves as regression_curves,
)
from .plausibility import (
    Plausibility as Plausibility,
    SpacePosition as SpacePosition,
    plausibility as plausibility,
    position_in_space as position_in_space,
)
from .several_classes import (
    SeveralClasses as SeveralClasses,
    classify_several as classify_several,
)
from .trait_axis import TraitAxis as TraitAxis, trait_axis as trait_axis
from .trait_model import TraitModel as TraitModel, trait_model as trait_model
from .trait_study import (
    TraitStudy as TraitStudy,
    TraitView as TraitView,
    study_trait as study_trait,
)
from .validation import (
    NestedPredictions as NestedPredictions,
    PermutationTest as PermutationTest,
    nested_leave_one_out as nested_leave_one_out,
    permutation_test as permutation_test,
)
from .walker_space import WalkerSpace as WalkerSpace
