"""How well sines do (Troje 2002, figure 3).

Above, how much of each eigenposture a capture holds from moment to moment; below, the sines that
take their place in the model. A walker is not far from four sines.
"""

import eigenwalker as ew

walk = ew.simulate_walk(seed=4, noise_mm=1)
walker = ew.decompose_pca(walk)
figure = ew.plotting.figure_scores(walk, walker)
figure.savefig("scores_and_sines.png")
