"""Women, men, and their difference tripled.

The four panels of Moler (2016). At the right each sex's average is moved away from the other's
until the difference is three times what it was: what is hard to see between averages is plain
between caricatures. Look at size first, then at shoulders beside hips and at the elbows.
"""

import eigenwalker as ew

people = ew.load_population()
is_man = (people.traits["sex"] == "male").to_numpy()
women, men = people.X[~is_man].mean(axis=0), people.X[is_man].mean(axis=0)
middle, half = (women + men) / 2, (men - women) / 2

figure = ew.plotting.figure_walkers(
    {
        "women": people.walker(women),
        "men": people.walker(men),
        "women, tripled": people.walker(middle - 3 * half),
        "men, tripled": people.walker(middle + 3 * half),
    },
    azimuths_deg=(0, 90),
)
figure.savefig("four_panels.png")
