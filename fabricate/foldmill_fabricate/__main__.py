"""``python -m foldmill_fabricate`` is the command ``foldmill``."""

from foldmill_fabricate.cli import main

if __name__ == "__main__":
    main()
