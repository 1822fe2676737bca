"""The HTTP API of a workshop: ``foldmill serve``.

Nothing here is imported by the rest of foldmill but by the command ``serve`` and the client. What
takes long, or reads what strangers send, runs in processes of ``sandbox``; the process that serves
requests and streams to plotters only waits for them.
"""
