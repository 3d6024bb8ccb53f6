"""From marker names to joints: marker sets, virtual markers, joint centres, label repair."""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
