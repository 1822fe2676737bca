"""The built-in families. Each knows ``foldmill`` only, never another family."""
