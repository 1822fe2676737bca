"""Jobs that survive: a queue for each plotter, gates a person answers, nothing ever cut twice."""

from foldmill_fabricate.jobs.desk import Desk as Desk
from foldmill_fabricate.jobs.desk import Jobs as Jobs
from foldmill_fabricate.jobs.places import Places as Places
from foldmill_fabricate.jobs.plans import Plans as Plans
from foldmill_fabricate.jobs.states import JobState as JobState
from foldmill_fabricate.jobs.store import JobStore as JobStore
from foldmill_fabricate.jobs.values import JobRecord as JobRecord
from foldmill_fabricate.jobs.values import Kind as Kind
from foldmill_fabricate.jobs.values import Order as Order
from foldmill_fabricate.jobs.values import Question as Question
from foldmill_fabricate.jobs.values import Reply as Reply
from foldmill_fabricate.jobs.values import Rest as Rest
from foldmill_fabricate.jobs.values import Submission as Submission
