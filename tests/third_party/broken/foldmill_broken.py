"""A plugin that cannot be loaded: it wants a module that nobody has."""

import a_module_that_nobody_has  # noqa: F401
