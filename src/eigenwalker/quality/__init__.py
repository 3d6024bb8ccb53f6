"""What is wrong with a capture, and the verdict on the walk that is used."""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
