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
    picture_of_strides as picture_of_strides,
)
from .eigenpostures import figure_eigenpostures as figure_eigenpostures
from .layout import Style as Style
from .parameter_figure import figure_parameters as figure_parameters
from .projection import observer_axes as observer_axes, project as project
from .walker_films import Background as Background, write_film as write_film
from .walker_space_figure import Space as Space, figure_space as figure_space
from .walkers import (
    draw_body as draw_body,
    figure_joints as figure_joints,
    figure_walkers as figure_walkers,
)
