"""What a person wants of a delivery that is under way, said from another thread."""

from __future__ import annotations

from threading import Event


class Wish:
    """Pause, go on, stop: set anywhere, heard by the delivery.

    A pause is heard where the tool is up: nothing more is sent then, the machine ends what it has,
    and the delivery waits. A stop is heard at once.
    """

    def __init__(self, above: Wish | None = None) -> None:
        """above : another wish that is heard, too."""
        self._paused, self._stopped, self._above = Event(), Event(), above

    def pause(self) -> None:
        """Pause where the tool is up next."""
        self._paused.set()

    def go_on(self) -> None:
        """Go on after a pause."""
        self._paused.clear()

    def stop(self) -> None:
        """Stop at once."""
        self._stopped.set()

    @property
    def paused(self) -> bool:
        """Whether a pause is wanted."""
        return self._paused.is_set() or (self._above is not None and self._above.paused)

    @property
    def stopped(self) -> bool:
        """Whether a stop is wanted."""
        return self._stopped.is_set() or (self._above is not None and self._above.stopped)
