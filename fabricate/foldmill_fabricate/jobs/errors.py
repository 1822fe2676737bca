"""What can go wrong with jobs, in sentences for those who submit them.

::

    FoldmillError
    ├── JobRefused (InvalidInput)    what a job, or its place in the queue, does not allow
    │   ├── NoSuchJob (LookupError)  an id that nothing has
    │   └── Clash                    a key, or an answer, that was used before for something else
    ├── Leave                        the process ends; the job is taken up again
    ├── Cancelled                    a person ends the job
    └── GivenUp                      its sheet is given up, and no other is wanted
"""

from __future__ import annotations

from foldmill.errors import FoldmillError, InvalidInput


class JobRefused(InvalidInput):
    """What a job does not allow as it stands."""


class NoSuchJob(JobRefused, LookupError):
    """A job, plan, question or plotter that there is not."""


class Clash(JobRefused):
    """What was said before otherwise: a key used for another job, a question answered already."""


class Leave(FoldmillError):
    """The process is ending: the machine is stopped, and the job waits as it is."""


class GivenUp(FoldmillError):
    """A sheet was given up, and no other is wanted in its place."""


class Cancelled(FoldmillError):
    """A person wants the job to end."""
