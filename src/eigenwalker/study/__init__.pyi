from .fit_folder import Study as Study, fit_folder as fit_folder
from .walker_from_file import walker_from_file as walker_from_file
