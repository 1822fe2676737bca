"""Geometry that the axisymmetric families share.

``points`` are what a user states, ``strip`` solves one half wedge, ``rosette`` mirrors and turns it
into a whole pattern and its folded form; ``slit`` opens that along a line, ``along_arc`` folds it
flat, and ``strap`` closes it again. ``editing`` adds and leaves out points. ``many`` judges whole
columns of parameters by the compiled kernels, and is what a strip family's ``batch`` is made of.

Terminology: p_i are points of the flat pattern, P_i of the folded form, i = 0…T. Odd points belong
to the line l1 and the plane Π1 (azimuth 0), even ones to l2 and Π2 (azimuth Θ = 180°/N). φ is the
angle of P0P1 with the z axis. A *branch* b = ±1 picks one of two places where P_i can be.
"""
