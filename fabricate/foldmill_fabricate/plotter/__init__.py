"""Driving a plotter: open a port, deliver a program, know that it was executed.

``link`` opens ports and ``lock`` keeps others off them, ``sender`` delivers, ``handshakes`` speak
what the machine's profile says, ``languages`` divide a program into what must stay whole,
``witness`` asks what is executed, ``ledger`` keeps it and ``resume`` takes a program up again;
``simulator`` stands in for a machine. Importing this package alone loads none of them.
"""
