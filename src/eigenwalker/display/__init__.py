"""Figures and films of walkers: draws what it is given."""
