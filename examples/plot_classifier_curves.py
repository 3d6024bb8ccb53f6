"""How many components tell the sexes apart (Troje 2002, figure 4).

With more components a classifier separates the walkers it was fitted to (dashed) without error;
those it has not seen (solid) it tells best with few. That structure and dynamics each tell
something was put into these simulated walkers; with captures of your own the figure shows what
people are like.
"""

import eigenwalker as ew
from eigenwalker.display.curves import figure_curves

people = ew.load_population().size_normalised()
parts = {
    "everything": "all",
    "structure": "structure",
    "dynamics": "dynamics",
    "first eigenposture": "p1",
}
curves = {
    title: ew.jackknife_curves(people.part(part), people.traits["sex"])
    for title, part in parts.items()
}
figure = figure_curves(curves, n_walkers=len(people), n_columns=2)
figure.savefig("classifier_curves.png")
