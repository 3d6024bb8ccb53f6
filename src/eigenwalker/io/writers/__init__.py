"""One file format a module: trajectories and walkers to bytes."""
