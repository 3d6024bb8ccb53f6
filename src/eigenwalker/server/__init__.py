"""The interactive page with Python behind it: captures read, populations fitted, films made."""

from eigenwalker.server.app import make_app as make_app
