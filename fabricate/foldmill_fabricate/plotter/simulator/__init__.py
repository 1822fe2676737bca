"""A plotter that is not there: try a whole job without hardware, and test senders with it.

It is a device, not a mock. Its input buffer counts every byte; device control is taken out ahead of
the buffer; programs in HP-GL, G-code (GRBL) and GP-GL are executed in order and take the time of
the machine's own motion model; answers come at the baud rate; faults happen on demand; and it draws
what it cut on each face of the sheet. docs/simulator.md says how it is used: in process
(``sim://``), as a serial port (a pseudo-terminal), on a TCP port, and by RFC 2217.

==========================  =================================================================
``machine``                 the whole: clock, line, device, sheets (``Simulator``)
``device``                  the frame: time, mains, faults; ``firmware``: what it asks of a language
``hp``                      device control and flow control of HP-GL machines
``control`` ``agreement``   ESC sequences; what they agree on
``parser`` ``hpgl``         HP-GL taken from the buffer unit by unit; what each unit does
``grbl`` ``grbl_motion``    GRBL: lines, planner, realtime characters; its motors
``gcode`` ``grbl_settings``  words of a line; ``$`` settings
``gpgl``                    GP-GL commands
``carriage`` ``drawing``    position, tool and pen; the strokes on each face (``draw``: pictures)
``buffer`` ``uart``         bytes that wait; bytes on the way
``modem``                   handshake lines
``faults`` ``quirks``       what goes wrong, and where machines differ from their manuals
``gauge`` ``trial``         how well a sender uses the line
``devices``                 which simulator stands behind which ``sim://`` address
``protocol_sim``            ``sim://`` for pyserial, which finds it by this package's name
``servers`` ``rfc2217``     pseudo-terminal and TCP port; network serial port
``offers`` ``run`` ``view``  the tool in a terminal
==========================  =================================================================
"""
