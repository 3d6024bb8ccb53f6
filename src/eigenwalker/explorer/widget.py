"""A walker in a notebook that plays, turns when dragged, and is linked to Python both ways."""

from __future__ import annotations

from typing import Any

import numpy as np

from eigenwalker.core.walker import Walker
from eigenwalker.explorer.interactive_page import MANNEQUIN
from eigenwalker.explorer.mixing import check_ranges, mixed_vector, mixed_walker
from eigenwalker.explorer.model import page_models, walker_model
from eigenwalker.population.population import Population
from eigenwalker.stimulus.html_page import built
from eigenwalker.stimulus.make import make_stimulus
from eigenwalker.stimulus.stimulus import Stimulus

try:
    import anywidget
    import traitlets
except ImportError as error:
    raise ImportError(
        "Walkers in notebooks need anywidget; install it with: pip install 'eigenwalker[notebook]'"
    ) from error

_SCRIPT = "widget.js"
_STYLES = ("dots", "sticks", "mannequin")
_STATE = {name: name for name in ("kind", "part", "bias", "strengths", "eigenwalkers")}
_STATE |= {"alpha": "traits", "start": "from"}
"""Attributes that make the walker, and what `mixed_vector` calls them."""
_LIGHT, _DARK = "#ffffff", "#000000"


def show(
    shown: Walker | Stimulus | Population | None = None,
    *,
    population: Population | None = None,
    **options: Any,
) -> WalkerWidget:
    """Return a widget that shows a walker in a notebook; it plays, and turns when dragged.

    As on the page, walkers of a population, and yours beside it, begin with size divided out
    (Troje 2002, eq. 12); ``keep_size=True``, or the switch in the widget, leaves it.

    Parameters
    ----------
    shown : Walker, Stimulus or Population, optional
        A population has a slider for each trait, and begins with its average walker. Left out, it
        is the built-in population.
    population : Population, optional
        Gives sliders for its traits to a `Walker`.
    **options
        Attributes of the widget at the start: ``azimuth_deg=90``.

    Returns
    -------
    WalkerWidget

    Raises
    ------
    ImportError
        If anywidget is not installed.
    ValueError
        If a walker cannot be compared with the population.

    See Also
    --------
    WalkerWidget : The widget itself.

    References
    ----------
    Troje (2002), eqs. 12 and 13, and demonstration 1.

    Examples
    --------
    >>> widget = show(ew.load_population(), azimuth_deg=90)
    >>> widget.alpha = {"sex": 2}  # the walker in the notebook moves too
    >>> ew.load_population().vector(widget.walker).shape
    (229,)
    """
    if shown is None and population is None:
        from eigenwalker.datasets.built_in import load_population

        shown = load_population()
    if isinstance(shown, Stimulus):
        return WalkerWidget(_stimulus=shown.to_dict(), **options)
    if isinstance(shown, Walker) and population is None:
        return WalkerWidget(_model=walker_model(shown), **options)
    if isinstance(shown, Walker) and population is not None:
        own = population.vector(shown).tolist()
        return WalkerWidget(_model=page_models(population), _own=own, start="own", **options)
    people = population if shown is None else shown
    if not isinstance(people, Population):
        raise ValueError(
            f"A notebook shows a Walker, a Stimulus or a Population; got {type(shown).__name__}."
        )
    return WalkerWidget(_model=page_models(people), **options)


class WalkerWidget(anywidget.AnyWidget):
    """A walker on a page of a notebook; made by `show`.

    Every attribute is linked both ways: set in Python it changes what is seen, and what is changed
    by hand can be read in Python, or watched with ``observe``. Assign new values rather than change
    old ones: ``widget.alpha = {**widget.alpha, "sex": 2}``.

    Attributes
    ----------
    alpha : dict of str to float
        Standard deviations along the axis of each trait, from -6 to 6. (``traits`` are the
        attributes themselves, in the widget's library.)
    keep_size : bool
        Whether walkers have their own size; otherwise all are as large as the average walker.
        Of use where a population is shown.
    kind, part : str
        As `trait_axis` takes them.
    start : "average", "own" or int
        The walker that is changed: the average, one's own, or a walker of the population by its
        number among those that the page holds.
    bias : dict or None
        ``{"trait": "sex", "steps": 1}``: steps of half the difference of two classes, from -3 to 3.
    strengths : list of float
        Factors of each component (stride, sway, hop, bounce), from -2 to 2.
    eigenwalkers : list of float
        Standard deviations along each, from -6 to 6.
    tempo : float
        Factor of the speed.
    azimuth_deg, elevation_deg, perspective
        The view.
    style : {"dots", "sticks", "mannequin"}
    trails, dark, playing, controls : bool
    cycle : float
        Phase of the stride while it does not play, from 0 to 1.
    height_px : int
        Height of the picture.

    See Also
    --------
    eigenwalker.show : Makes one of a walker, a population or a walk.
    """

    _model = traitlets.Dict(default_value=None, allow_none=True).tag(sync=True)
    _stimulus = traitlets.Dict(default_value=None, allow_none=True).tag(sync=True)
    _own = traitlets.List(traitlets.Float(), default_value=None, allow_none=True).tag(sync=True)
    alpha = traitlets.Dict(value_trait=traitlets.CFloat(), key_trait=traitlets.Unicode()).tag(
        sync=True
    )
    keep_size = traitlets.Bool(False).tag(sync=True)
    kind = traitlets.Enum(["discriminant", "mean_difference"], "discriminant").tag(sync=True)
    part = traitlets.Unicode("all").tag(sync=True)
    start = traitlets.Union(
        [traitlets.Int(), traitlets.Enum(["average", "own"])], default_value="average"
    ).tag(sync=True)
    bias = traitlets.Dict(default_value=None, allow_none=True).tag(sync=True)
    strengths = traitlets.List(traitlets.CFloat()).tag(sync=True)
    eigenwalkers = traitlets.List(traitlets.CFloat()).tag(sync=True)
    tempo = traitlets.CFloat(1.0, min=0.1, max=3.0).tag(sync=True)
    azimuth_deg = traitlets.CFloat(30.0).tag(sync=True)
    elevation_deg = traitlets.CFloat(0.0, min=-30.0, max=90.0).tag(sync=True)
    perspective = traitlets.Bool(False).tag(sync=True)
    style = traitlets.Enum(_STYLES, "dots").tag(sync=True)
    trails = traitlets.Bool(False).tag(sync=True)
    dark = traitlets.Bool(True).tag(sync=True)
    playing = traitlets.Bool(True).tag(sync=True)
    cycle = traitlets.CFloat(0.0, min=0.0, max=1.0).tag(sync=True)
    controls = traitlets.Bool(True).tag(sync=True)
    height_px = traitlets.Int(380, min=80, max=2000).tag(sync=True)

    def __init__(self, **attributes: Any) -> None:
        self._esm = built(_SCRIPT)
        unknown = sorted(set(attributes) - set(self.trait_names()))
        if unknown:
            raise ValueError(f"A walker in a notebook has no {unknown}; see help(WalkerWidget).")
        super().__init__(**attributes)
        self.on_msg(_send_mannequin)

    @traitlets.validate(*_STATE)
    def _check_walker(self, proposal: Any) -> Any:
        """Refuse what the model does not have, before it reaches the page."""
        if model := self._sized_model():
            try:
                state = self._state(**{proposal["trait"].name: proposal["value"]})
                check_ranges(state)
                mixed_vector(model, state)
            except (ValueError, TypeError, KeyError) as error:
                raise traitlets.TraitError(str(error)) from None
        return proposal["value"]

    def _state(self, **changes: Any) -> dict[str, Any]:
        values = {name: getattr(self, name) for name in _STATE if name not in changes} | changes
        return {"own": self._own} | {_STATE[name]: value for name, value in values.items()}

    @property
    def vector(self) -> np.ndarray:
        """The features of the walker now shown: array of shape (feature,)."""
        return mixed_vector(self._model_or_refuse(), self._state())

    @property
    def walker(self) -> Walker:
        """The walker now shown."""
        return mixed_walker(self._model_or_refuse(), self._state())

    @property
    def stimulus(self) -> Stimulus:
        """What is now shown as a stimulus, to be saved, filmed or changed further."""
        if self._stimulus is not None:
            return Stimulus.from_dict(self._stimulus)
        return make_stimulus(
            self.walker,
            azimuth_deg=self.azimuth_deg,
            elevation_deg=self.elevation_deg,
            style=self.style,  # pyright: ignore[reportArgumentType] - one of the three
            colour=_LIGHT if self.dark else _DARK,
            background=_DARK if self.dark else _LIGHT,
        )

    def _sized_model(self) -> dict[str, Any] | None:
        """The model whose walkers have their size, or not, as is chosen."""
        model = self._model
        if model is not None and model.get("size_kept") not in (None, self.keep_size):
            return model["other_size"]
        return model

    def _model_or_refuse(self) -> dict[str, Any]:
        model = self._sized_model()
        if model is None:
            raise ValueError("A stimulus is shown; its figures are in widget.stimulus.figures.")
        return model


def _send_mannequin(widget: WalkerWidget, message: Any, _buffers: Any) -> None:
    """Send the module that draws mannequins, half a megabyte, when it is first asked for."""
    if message == {"wants": "mannequin"}:
        widget.send({"mannequin": built(MANNEQUIN)})
