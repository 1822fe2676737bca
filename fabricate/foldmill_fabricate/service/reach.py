"""Where this user's service is reached; read by those who want to talk to it."""

from __future__ import annotations

import json
import os
import socket
from contextlib import suppress
from urllib.parse import urlsplit

from foldmill_fabricate.jobs.places import Places


def reached(places: Places | None = None) -> str | None:
    """Return the address of the service that runs on this folder; None where none does."""
    try:
        said = json.loads((places or Places()).service.read_bytes())
        with suppress(PermissionError):  # another user's, and alive
            os.kill(said["pid"], 0)
        url = str(said["url"])
    except (OSError, ValueError, KeyError, TypeError):
        return None
    return url if _is_listened_at(url) else None


def _is_listened_at(url: str) -> bool:
    """Tell whether anybody is there: after a power cut another process may have the number."""
    place = urlsplit(url)
    try:
        socket.create_connection((place.hostname, place.port or 80), 5.0).close()
    except (ConnectionRefusedError, ValueError):
        return False
    except OSError:
        return True  # busy; who asks it will tell
    return True
