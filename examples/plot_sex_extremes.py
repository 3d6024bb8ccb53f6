"""From one sex to the other and beyond.

The average walker moved along the axis of sex by -6 to +6 standard deviations of the walkers
(Troje 2002, eq. 13). At -3 and +3 few people walk like that, at 6 nobody does: these are
caricatures. Look at the width of shoulders beside hips, at how far out the elbows are, and at the
sway of the upper body in the film.
"""

import eigenwalker as ew

people = ew.load_population()
sex = ew.trait_axis(people, "sex", kind="mean_difference")
walkers = {
    f"{alpha:+d} SD" if alpha else "average": people.walker(people.average + alpha * sex.step)
    for alpha in (-6, -3, 0, 3, 6)
}

figure = ew.plotting.figure_walkers(walkers)
figure.savefig("sex_extremes.png")

ew.plotting.write_film(
    list(walkers.values()),
    "sex_extremes.mp4",
    n_strides=2,
    azimuth_deg=0,
    style="sticks",
    titles=list(walkers),
)
