"""Point-light stimuli: figures, transforms, one file that Python and the browser play alike."""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
