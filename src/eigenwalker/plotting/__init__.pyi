from .components import figure_scores as figure_scores, figure_variance as figure_variance
from .curves import (
    Curves as Curves,
    TraitCurves as TraitCurves,
    figure_curves as figure_curves,
    figure_regression_curves as figure_regression_curves,
)
from .difference_maps import (
    MapPicture as MapPicture,
    figure_maps as figure_maps,
    figure_two_walks as figure_two_walks,
)
from .eigenpostures import figure_eigenpostures as figure_eigenpostures
from .layout import Style as Style
from .projection import project as project
from .walker_films import Background as Background, write_film as write_film
from .walker_space_figure import Space as Space, figure_space as figure_space
from .walkers import figure_joints as figure_joints, figure_walkers as figure_walkers
