from .blocks import Report as Report
from .html_report import write_report as write_report
