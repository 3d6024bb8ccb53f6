"""The average walker as a point-light display.

Fifteen white dots on black. Stopped, they look like nothing much; as soon as they move one sees
somebody walk. The film holds two strides and repeats without a seam.
"""

import eigenwalker as ew

people = ew.load_population()
average = people.walker(people.average)
ew.plotting.write_film(average, "average_walker.gif", n_strides=2, azimuth_deg=30, size_px=400)
