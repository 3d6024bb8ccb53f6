"""The nouns and their mathematics: trajectories, skeletons, walkers."""

import lazy_loader  # pyright: ignore[reportMissingTypeStubs] - untyped

# pyright: reportUnknownVariableType=false, reportUnknownMemberType=false
__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
