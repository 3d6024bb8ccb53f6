"""Experiments with observers: designs, the order of trials, the store of answers, the export."""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
