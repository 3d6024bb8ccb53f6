"""How different two walks are: motion maps, registration, loops, distances (Pražák et al. 2010)."""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
