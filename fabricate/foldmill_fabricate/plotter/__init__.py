"""Driving a plotter: open a port, deliver a program, know that it was executed.

``link`` opens ports, ``sender`` delivers, ``session`` and ``pacing`` speak what the machine's
profile says, ``program`` cuts a program into whole instructions, and ``simulator`` stands in for a
machine. Importing this package alone loads none of them.
"""
