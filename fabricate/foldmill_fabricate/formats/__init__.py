"""Writers: a plan to the bytes of a file. Each is one pure function, offered through a hook.

``hpgl``, ``gpgl`` and ``gcode`` write the programs a machine runs; ``svg``, ``dxf`` and ``cf2``
write drawings for other people's software. None of them reads a file, a clock or a device.
"""
