"""Strokes: how lines become motions of a tool, in which order, and how long they take."""
