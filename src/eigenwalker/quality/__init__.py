"""What a capture is worth: what is in it, what is wrong with it, and the verdict."""

from eigenwalker.quality.findings import Quality as Quality
from eigenwalker.quality.findings import assess as assess
from eigenwalker.quality.verdict import Verdict as Verdict
