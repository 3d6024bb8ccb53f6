"""What varies between walkers, what tells them apart, and how sure that is."""

import lazy_loader  # pyright: ignore[reportMissingTypeStubs] - untyped

# pyright: reportUnknownVariableType=false, reportUnknownMemberType=false
__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
