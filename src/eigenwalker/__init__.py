"""How people walk, and how people see others walk.

Captures of walking people in; a model of how they walk, classifiers, walkers of any trait out,
after Troje (2002). Import it as ``import eigenwalker as ew``; names load when first used. What one
needs every day stands here, the rest in rooms: ``ew.gait``, ``ew.analysis``, ``ew.metric``, ...
"""

import lazy_loader

from eigenwalker._version import __version__ as __version__

_ALIASES = {
    *("assess", "direction", "jackknife_curves", "loop"),
    *("motion_map", "read_walkers_mat", "register"),
    *("agreement", "crossed_logistic", "difference_table", "fit_choice_model", "mixed_anova"),
    *("psychometric", "scheffe", "sensitivity", "spearman_critical"),
}
"""Names of rooms that also work from the top, and are not listed there."""

__getattr__, _, _names = lazy_loader.attach_stub(__name__, __file__)
__all__ = sorted({*_names} - _ALIASES - {"__version__"})


def __dir__() -> list[str]:
    return [*__all__]
