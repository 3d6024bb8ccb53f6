from .capture_table import capture_table as capture_table
from .fit_folder import Study as Study, fit_folder as fit_folder
from .inspect import inspect_file as inspect_file
from .messages import reasons as reasons, summarise as summarise
from .parameter_table import (
    ParameterTable as ParameterTable,
    parameter_table as parameter_table,
)
from .predict_captures import (
    Predictions as Predictions,
    predict_captures as predict_captures,
)
from .process_capture import (
    CaptureResult as CaptureResult,
    NoWalkError as NoWalkError,
    process_capture as process_capture,
)
from .reference_pairs import (
    ReferenceComparison as ReferenceComparison,
    compare_with_references as compare_with_references,
    self_distance as self_distance,
    simulated_distances as simulated_distances,
)
from .walks import (
    CaptureWalk as CaptureWalk,
    Walks as Walks,
    walk_of_capture as walk_of_capture,
    walker_space_distances as walker_space_distances,
    walks_of_folder as walks_of_folder,
    walks_of_population as walks_of_population,
)
