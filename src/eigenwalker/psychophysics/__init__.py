"""From observers' answers to numbers: trials, choice models, the perceptual metric."""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
