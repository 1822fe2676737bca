"""Proof two: the plan is what pattern, process rule and placements ask for. No more and no less."""

from __future__ import annotations

from foldmill import CreasePattern
from foldmill.finding import Finding
from foldmill_fabricate.passes import Plan
from foldmill_fabricate.verify.asked import Asked
from foldmill_fabricate.verify.copies import prove_copies
from foldmill_fabricate.verify.coupon import prove_coupon
from foldmill_fabricate.verify.creases import prove_creases
from foldmill_fabricate.verify.cuts import prove_cuts
from foldmill_fabricate.verify.drawn import prove_drawn
from foldmill_fabricate.verify.lead_ins import prove_lead_ins
from foldmill_fabricate.verify.nesting import prove_nesting
from foldmill_fabricate.verify.planned import planned
from foldmill_fabricate.verify.process import prove_order, prove_process
from foldmill_fabricate.verify.register import prove_register
from foldmill_fabricate.verify.relief import prove_relief
from foldmill_fabricate.verify.rest import prove_rest
from foldmill_fabricate.verify.waste import prove_waste


def prove_rule(plan: Plan, pattern: CreasePattern) -> list[Finding]:
    """Derive again what the plan must hold, and compare; nothing of the planner is used.

    Of a plan that goes on with a sheet: the plan it was begun from is the pattern's, and this one
    holds what is not there yet.
    """
    if plan.remakes is not None:
        return [*prove_rule(plan.remakes.origin, pattern), *prove_rest(plan, plan.remakes)]
    strokes = planned(plan)
    if plan.source is not None:
        return prove_drawn(plan, plan.source, strokes)
    asked = Asked(plan, pattern)
    if plan.coupon is not None:
        return [
            *prove_order(plan),
            *prove_coupon(asked, plan.coupon, strokes),
            *prove_waste(asked, strokes),
            *prove_lead_ins(asked),
        ]
    return [
        *prove_process(plan),
        *prove_copies(asked, strokes),
        *prove_creases(asked, strokes),
        *prove_cuts(asked, strokes),
        *prove_nesting(strokes),
        *prove_relief(asked, strokes),
        *prove_waste(asked, strokes),
        *prove_register(asked, strokes),
        *prove_lead_ins(asked),
    ]
