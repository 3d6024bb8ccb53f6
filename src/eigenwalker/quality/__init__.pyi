from .assessment import assess as assess
from .quality import Finding as Finding, Quality as Quality, Verdict as Verdict
