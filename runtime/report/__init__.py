"""A recorded run as one page to look at, and as a story to read."""

from runtime.report.page import page
from runtime.report.writing import write_report

__all__ = ["page", "write_report"]
