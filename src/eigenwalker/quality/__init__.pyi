from .anthropometry import WrongJoint as WrongJoint
from .assessment import assess as assess
from .quality import Quality as Quality, Verdict as Verdict
