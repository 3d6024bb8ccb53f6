"""What a walk is made of.

The first eigenposture is the stride itself; the second, a quarter of a stride later, shifts the
body from leg to leg; the third and fourth ride on twice the frequency, as both steps of a stride
do the same to them. Blue is the mean posture plus the eigenposture, red minus.
"""

import eigenwalker as ew

walk = ew.simulate_walk(seed=1)
walker = ew.decompose_pca(walk)
figure = ew.plotting.figure_eigenpostures(walker)
figure.savefig("eigenpostures.png")
