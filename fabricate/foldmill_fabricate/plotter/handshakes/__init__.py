"""The ways in which machines say that they have room, and what is done where they do not.

===========  ==========================================================================
``choice``   which of them a profile asks for
``feed``     what all have in common
``hp``       asking an HP-GL machine; ``proving``: its proofs between strokes
``asked``    ESC.B
``modelled`` none, XON/XOFF, RTS/CTS; ``paced``: a throttle; ``blocks``: ENQ/ACK and DTR
``grbl``     asking GRBL; ``counted``: character counting
``gpgl``     GP-GL's status
===========  ==========================================================================
"""
