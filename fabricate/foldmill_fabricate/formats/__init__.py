"""Writers: a plan to the bytes of a file. Each is one pure function, offered through a hook.

``hpgl`` writes the programs a plotter runs; ``svg`` and ``dxf`` write drawings for other people's
software. None of them reads a file, a clock or a device.
"""
