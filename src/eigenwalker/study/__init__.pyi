from .fit_folder import Study as Study, fit_folder as fit_folder
from .walker_from_file import walker_from_file as walker_from_file
from .walks import (
    Walks as Walks,
    walker_space_distances as walker_space_distances,
    walks_of_folder as walks_of_folder,
    walks_of_population as walks_of_population,
)
