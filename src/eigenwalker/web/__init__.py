"""What every page with Python behind it needs of a server: host checks, start and stop."""
