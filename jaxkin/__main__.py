"""`python -m jaxkin` is the command line."""

from jaxkin.cli import main

main()
