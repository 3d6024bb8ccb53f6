"""Where people are in the space they span.

Each point is a walker, by its scores on the two eigenwalkers of most variance. Sex is not one of
them (Moler 2016): its axis, of which the line is the shadow in this plane, lies across many.
"""

import eigenwalker as ew

people = ew.load_population()
sex = ew.trait_axis(people, "sex")
figure = ew.plotting.figure_space(
    ew.WalkerSpace().fit(people.X),
    people.X,
    people.traits["sex"],
    trait_name="sex",
    step=sex.step,
    poles=("female", "male"),
)
figure.savefig("population_space.png")
