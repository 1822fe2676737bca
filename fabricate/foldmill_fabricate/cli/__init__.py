"""The command ``foldmill``. Each subcommand is a thin caller of one function of the packages."""

from foldmill_fabricate.cli.app import main

__all__ = ["main"]
