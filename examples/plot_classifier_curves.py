"""How many components tell the sexes apart (Troje 2002, figure 4).

Dashed, the walkers that a classifier was fitted to: with enough components it misses none of them.
Solid, walkers that it had not seen: it goes on to miss some, and the ring marks the fewest. Always
answering one sex would miss 20 of the 40. These walkers are simulated, so the curves tell what was
put into them; with captures of your own they tell what people are like.
"""

import eigenwalker as ew

people = ew.load_population().size_normalised()
parts = {
    "everything, size divided out": "all",
    "structure": "structure",
    "dynamics": "dynamics",
    "first eigenposture": "p1",
}
curves = {
    title: ew.jackknife_curves(people.part(part), people.traits["sex"])
    for title, part in parts.items()
}
figure = ew.plotting.figure_curves(curves, n_walkers=len(people), n_columns=2)
figure.savefig("classifier_curves.png")
