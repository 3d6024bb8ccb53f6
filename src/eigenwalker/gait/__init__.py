"""One walk as a periodic movement: frequency, steady strides, in place, events, parameters."""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
