"""What planning says of the stored offset between a machine's two sides."""

from __future__ import annotations

from collections.abc import Iterator

from foldmill.finding import Finding, Severity
from foldmill_fabricate.passes import Plan
from foldmill_fabricate.writers import writer


def findings(plan: Plan) -> Iterator[Finding]:
    """Yield what keeps a stored offset from being made up for, where one is stored."""
    stored = plan.machine.two_sides
    if not stored.is_known or len(plan.passes) < 2 or plan.registration.kind == "l-marks":
        return
    told = f"Its two sides are {stored.dx:+.2f}, {stored.dy:+.2f} mm and {stored.angle:+.3f}° apart"
    if stored.flip != plan.flip.kind:
        yield _warning(
            f"{told} on sheets turned {stored.flip}, and this one is turned {plan.flip.kind}: "
            f"nothing is made up for.",
            f"Plan with --flip {stored.flip}, or measure a coupon turned like this one.",
        )
    elif writer(plan.machine) is None:
        yield _warning(
            f"{told}, and a drawing shows the sheet as it ought to lie: nothing is made up for.",
            "Shift and turn the reverse drawing by as much in the machine's own software.",
        )


def _warning(message: str, remedy: str) -> Finding:
    return Finding("two-sides", Severity.WARNING, "reverse pass", message, remedy)
