"""How a command ends: 0 when all went well, else one of these."""

EXIT_PARTIAL = 1
"""Some files could not be used; the others were."""
EXIT_FAILED = 2
EXIT_INTERRUPTED = 130
