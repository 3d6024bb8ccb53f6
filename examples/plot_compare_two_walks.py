"""How different two walks are, and where (Pražák et al. 2010, fig. 1).

A happy walker and a sad one of the same average body, both shown on the neutral mannequin. In the
maps frames are dark that are alike. The first is of the happy walk and itself: stripes half a
stride apart, as left and right do the same. The second is of both walks; the red line, along which
their difference is measured, tells which moments correspond. The second picture lays the walks over
each other at such moments.
"""

import numpy as np

import eigenwalker as ew
from eigenwalker.plotting import (
    MapPicture,
    figure_maps,
    figure_two_walks,
    picture_of_strides,
)

people = ew.load_population()
step = ew.trait_axis(people, "happy").step
time = np.arange(0, 4, 1 / 60)
happy, sad = (
    ew.metric.retarget(people.walker(people.average + alpha * step).trajectories(time))
    for alpha in (4, -4)
)

found = ew.metric.compare_walks(happy, sad, metric="positions-sigmoid")
print(f"{found.distance:.3f}, of which {found.shares.round(2).to_dict()}")

itself, both = ew.motion_map(happy), found.registration.map
clocks = both.time_a.values, both.time_b.values
names = ("happy", "sad")
figure = figure_maps(
    [
        MapPicture(itself.values, time, time, "happy and happy", "mm", names=("happy", "happy")),
        picture_of_strides(
            both.values, *clocks, found.registration.times, "two strides of each", names=names
        ),
    ]
)
figure.savefig("motion_maps.png")

first, second = found.registration.on_common_clock()
markers = [str(name) for name in first.marker.values]
figure_two_walks(first.values, second.values, markers, names=names).savefig("two_walks.png")
