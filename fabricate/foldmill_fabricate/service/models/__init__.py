"""What goes over the wire, both ways: the same values for the service and for its client.

Lengths in mm, angles in degrees, times in s. An *id* of a pattern or plan is a digest of what it
was made from: the same request gives the same id, and no id is a path.
"""

from foldmill_fabricate.plan_options import PlanOptions
from foldmill_fabricate.service.models.offered import (
    About,
    Family,
    FamilyRow,
    FieldRow,
    Health,
    PresetPage,
    PresetRow,
)
from foldmill_fabricate.service.models.patterns import DesignRequest, Pattern, Report, Upload
from foldmill_fabricate.service.models.plans import (
    FileRow,
    KeptPlan,
    PlanFigures,
    PlanRequest,
    PlanState,
    PlanStatus,
    Verification,
)
from foldmill_fabricate.service.models.shop import (
    Nothing,
    PlotterStatus,
    Priority,
    ProgramRow,
    SheetPage,
)
from foldmill_fabricate.service.models.wire import DIGEST, Digest, Problem, Slug, Wire

__all__ = [
    "DIGEST",
    "About",
    "DesignRequest",
    "Digest",
    "Family",
    "FamilyRow",
    "FieldRow",
    "FileRow",
    "Health",
    "KeptPlan",
    "Nothing",
    "Pattern",
    "PlanFigures",
    "PlanOptions",
    "PlanRequest",
    "PlanState",
    "PlanStatus",
    "PlotterStatus",
    "PresetPage",
    "PresetRow",
    "Priority",
    "Problem",
    "ProgramRow",
    "Report",
    "SheetPage",
    "Slug",
    "Upload",
    "Verification",
    "Wire",
]
