"""``python -m eigenwalker`` is the command line."""

from eigenwalker.cli.main import main

main()
