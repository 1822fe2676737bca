"""A plotter that is not there: try a whole job without hardware, and test senders with it.

It is a device, not a mock. Its input buffer counts every byte; device control (ESC .) is taken out
ahead of the buffer; HP-GL is executed in parse order and takes the time of the machine's own
motion model; answers come at the baud rate; and it draws what it cut on each face of the sheet.
README.md beside this file says how it is used: in process (``sim://``), as a serial port (a
pseudo-terminal) and on a TCP port.

======================  =====================================================================
``machine``           the whole: clock, line, device, sheets (``Simulator``)
``device``            buffer, device control, flow control, execution in parse order, faults
``control`` ``parser``  ESC sequences; HP-GL taken from the buffer unit by unit
``carriage``          the mechanics: positions, times, answers, errors
``drawing`` ``draw``  the strokes on each face; their pictures
``gauge``             how well a sender uses the line
``devices``           which simulator stands behind which ``sim://`` address
``protocol_sim``      ``sim://`` for pyserial, which finds it by this package's name
``servers`` ``run``   pseudo-terminal and TCP port; the tool in a terminal
======================  =====================================================================
"""
