from .blocks import (
    Block as Block,
    Cell as Cell,
    Code as Code,
    Figure as Figure,
    Film as Film,
    Items as Items,
    Link as Link,
    Report as Report,
    Section as Section,
    Table as Table,
    Text as Text,
)
from .classification_report import write_classification_report as write_classification_report
from .html_report import write_report as write_report
from .metric_fit_report import write_metric_fit_report as write_metric_fit_report
from .pair_report import write_pair_report as write_pair_report
from .pairs_report import write_pairs_report as write_pairs_report
from .parameters_report import write_parameters_report as write_parameters_report
