"""What the operator has to do at each gate, in words and, for the flip, drawn."""

from __future__ import annotations

from foldmill_fabricate.gates import Request, thickness_range
from foldmill_fabricate.passes import Face, Gate, Plan


def instruction(request: Request) -> str:
    """Return in words what the operator has to do."""
    told = _told(request)
    return f"{request.warning}\n{told}" if request.warning else told


def _told(request: Request) -> str:
    return {
        Gate.LOAD: _load,
        Gate.TOOL: _tool,
        Gate.FLIP: _flip,
        Gate.RE_REGISTER: _re_register,
        Gate.REMOVE: _remove,
    }[request.gate](request)


def _load(request: Request) -> str:
    plan, face = request.plan, request.face
    side = "front (outside)" if face is Face.FRONT else "reverse (inside)"
    low, high = thickness_range(plan)
    where = "on both faces, in the waste" if len(plan.passes) > 1 else "in the waste"
    return (
        f"Load a {plan.sheet.width:g} × {plan.sheet.height:g} mm sheet of {plan.material.title}, "
        f"{low:.2f} to {high:.2f} mm thick, on the mat, its lower left corner at "
        f"({plan.sheet.dx:g}, {plan.sheet.dy:g}) mm, the {side} up.{_against(face, plan)} "
        f"Write its id {request.sheet} {where}.{_tools(plan)}"
    )


def _tools(plan: Plan) -> str:
    """Return how tools are set that the machine changes by itself; nobody is asked later."""
    if plan.machine.tools.change == "operator":
        return ""
    setups = {one.tool: one for work in plan.passes for one in work.setups}
    told = "; ".join(
        f"tool {tool} {one.process}, exposure {one.exposure:g} mm" for tool, one in setups.items()
    )
    return f" Set its tools: {told}."


def _tool(request: Request) -> str:
    setup = request.setup
    return (
        f"Set the tool for {setup.name}: exposure {setup.exposure:g} mm, force {setup.force:g} gf, "
        f"speed {setup.speed / 10:g} cm/s."
    )


def _flip(request: Request) -> str:
    from foldmill_fabricate.files import write_whole
    from foldmill_fabricate.jobsheet.flip_drawing import flip_picture
    from foldmill_fabricate.jobsheet.flip_text import flip_text

    plan = request.plan
    side = "bottom" if plan.flip.kind == "left-right" else "left"
    told = (
        f"Turn sheet {request.sheet} over {plan.flip.kind}: the {side} edge stays where it is. The "
        f"F in the waste must now be on the underside.{_against(request.face, plan)}"
    )
    drawn = f"{told}\n\n{flip_text(plan, request.sheet)}\n"
    if request.picture is None:
        return drawn
    if not request.picture.exists():
        write_whole(request.picture, flip_picture(plan, request.sheet))
    return f"{drawn}\nThe same as a picture: {request.picture}"


def _re_register(request: Request) -> str:
    return (
        f"Work goes on on sheet {request.sheet}, its {request.face} up. It must lie as it lay. If "
        "it was moved or taken off, lay it as it was laid before."
        f"{_against(request.face, request.plan)}"
    )


def _remove(request: Request) -> str:
    ties = len(request.plan.ties)
    told = f" The part hangs on {ties} ties: cut them, do not tear them." if ties else ""
    return f"Sheet {request.sheet} is done. Lift the tool, take the sheet off.{told}"


def _against(face: Face, plan: Plan) -> str:
    """Return what to do about registration when the sheet is laid, after a blank; or nothing."""
    made = plan.registration
    if made.kind == "edge":
        spots = ", ".join(
            f"{stop.edge} ({stop.x:g}, {stop.y:g})" for stop in made.stops if stop.face is face
        )
        return f" Push its edges against the stops, mm on the mat: {spots}."
    if face is Face.FRONT:
        return ""
    if made.kind == "pins":
        spots = " and ".join(f"({x:g}, {y:g})" for x, y in made.pins)
        return f" Press it down over the pins at {spots} mm."
    if made.kind == "l-marks":
        return " Put dark tape under the cut marks first, and let the machine search them now."
    return ""
