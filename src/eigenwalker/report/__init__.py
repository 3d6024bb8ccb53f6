"""Report pages: one file of HTML that needs nothing else."""
