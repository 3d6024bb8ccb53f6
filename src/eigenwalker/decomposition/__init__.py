"""One walk as a mean posture and postures on sines: PCA (Troje 2002) or Fourier (WDP2002)."""

import lazy_loader  # pyright: ignore[reportMissingTypeStubs] - untyped

# pyright: reportUnknownVariableType=false, reportUnknownMemberType=false
__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
