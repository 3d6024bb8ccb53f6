from .findings import Quality as Quality, assess as assess
from .verdict import Verdict as Verdict
