"""The older name of what the package clathra reads."""
from clathra import probe_names, read_csv, read_snapshots  # noqa: F401
