"""Ways in which good programs go wrong. Each is done to the bytes, whoever wrote them."""

from __future__ import annotations

import re
from collections.abc import Callable

from fabricate.verify.square_job import Job, files_of, recorded

from foldmill_fabricate.passes import Face, Role

Steps = tuple[int, int]
Part = str | list[Steps]
_STROKE = re.compile(r"PU-?\d+,-?\d+;\s*(?:PD[-\d,]+;\s*)+")


def read(program: bytes) -> list[Part]:
    """Split a program into strokes and the text between them."""
    text = program.decode()
    parts: list[Part] = []
    place = 0
    for match in _STROKE.finditer(text):
        parts.append(text[place : match.start()])
        numbers = [int(word) for word in re.findall(r"-?\d+", match[0])]
        parts.append(list(zip(numbers[::2], numbers[1::2], strict=True)))
        place = match.end()
    return [*parts, text[place:]]


def written(parts: list[Part]) -> bytes:
    text = ""
    for part in parts:
        if isinstance(part, str):
            text += part
        else:
            pairs = [f"{x},{y}" for x, y in part]
            text += f"PU{pairs[0]};PD{','.join(pairs[1:])};\n"
    return text.encode()


def locate(job: Job, role: Role, face: Face, nth: int = 0) -> tuple[str, int]:
    """Return program and part number of the nth stroke of a role on a face."""
    setups = {setup.number: setup for side in job.plan.passes for setup in side.setups}
    for file in files_of(job.plan):
        roles = [
            operation.role
            for number in file.setups
            for operation in setups[number].operations
            for _ in operation.strokes
        ]
        if file.face is face and role in roles:
            strokes = [k for k, p in enumerate(read(job.programs[file.name])) if type(p) is list]
            return file.name, strokes[roles.index(role) + nth]
    raise LookupError(f"no {role} on the {face}")


def stroke_of(job: Job, name: str, part: int) -> list[Steps]:
    found = read(job.programs[name])[part]
    assert not isinstance(found, str)
    return found


def with_part(job: Job, name: str, part: int, *new: Part) -> Job:
    """Put other parts in the place of one."""
    parts = read(job.programs[name])
    parts[part : part + 1] = new
    return with_program(job, name, written(parts))


def with_program(job: Job, name: str, data: bytes) -> Job:
    return recorded(Job(job.plan, job.pattern, {**job.programs, name: data}))


def moved_all(job: Job, face: Face, move: Callable[[Steps], Steps]) -> Job:
    """Move every point of a face's programs."""
    for file in files_of(job.plan):
        if file.face is face:
            parts = read(job.programs[file.name])
            moved = [p if isinstance(p, str) else [move(xy) for xy in p] for p in parts]
            job = with_program(job, file.name, written(moved))
    return job


def mirrored(job: Job) -> Callable[[Steps], Steps]:
    """Turn the sheet over on its carrier, in steps."""
    plan = job.plan
    units = plan.machine.axes.units_per_mm
    if plan.flip.kind == "left-right":
        twice = round(2 * (plan.flip.axis + plan.sheet.dx) * units)
        return lambda xy: (twice - xy[0], xy[1])
    twice = round(2 * (plan.flip.axis + plan.sheet.dy) * units)
    return lambda xy: (xy[0], twice - xy[1])


def a_stroke_is_missing(job: Job) -> Job:
    return with_part(job, *locate(job, Role.SCORE, Face.REVERSE, 1))


def a_stroke_is_on_the_wrong_face(job: Job) -> Job:
    name, part = locate(job, Role.SCORE, Face.REVERSE, 1)
    seen_from_the_front = [mirrored(job)(xy) for xy in stroke_of(job, name, part)]
    front, place = locate(job, Role.SCORE, Face.FRONT)
    job = with_part(job, name, part)
    return with_part(job, front, place, stroke_of(job, front, place), seen_from_the_front)


def the_reverse_is_not_mirrored(job: Job) -> Job:
    return moved_all(job, Face.REVERSE, mirrored(job))


def the_front_is_mirrored(job: Job) -> Job:
    return moved_all(job, Face.FRONT, mirrored(job))


def everything_is_scaled_by_1021_to_1016(job: Job) -> Job:
    for face in Face:
        job = moved_all(
            job, face, lambda xy: (round(xy[0] * 1021 / 1016), round(xy[1] * 1021 / 1016))
        )
    return job


def a_point_is_outside_the_range(job: Job) -> Job:
    return _corner_at(job, (-40, 4000))


def a_point_is_beside_the_carrier(job: Job) -> Job:
    return _corner_at(job, (round(job.plan.sheet.carrier_width * 40) - 200, 4000))


def _corner_at(job: Job, point: Steps) -> Job:
    name, part = locate(job, Role.SCORE, Face.FRONT)
    stroke = stroke_of(job, name, part)
    return with_part(job, name, part, [stroke[0], point, *stroke[2:]])


def the_outline_is_cut_before_the_scores(job: Job) -> Job:
    """Change places: of two programs, or of the two halves of one."""
    reverse = [file for file in files_of(job.plan) if file.face is Face.REVERSE]
    if len(reverse) > 1:
        one, two = (job.programs[file.name] for file in reverse)
        swapped = {reverse[0].name: two, reverse[1].name: one}
        return recorded(Job(job.plan, job.pattern, {**job.programs, **swapped}))
    name = reverse[0].name
    text = job.programs[name].decode()
    head, *halves, tail = re.split(r"(?=SP\d+;)", text)
    swapped_text = f"{head}{halves[1]}PU;{halves[0]}{tail}"
    return with_program(job, name, swapped_text.encode())


def a_crease_is_cut_once_more(job: Job) -> Job:
    name, part = locate(job, Role.SCORE, Face.FRONT, 1)
    stroke = stroke_of(job, name, part)
    once = stroke[: len(stroke) // 2 + 1]  # it is gone over there and back
    return with_part(job, name, part, [*stroke, *once[1:]])


def a_crease_is_cut_once_less(job: Job) -> Job:
    name, part = locate(job, Role.SCORE, Face.FRONT, 1)
    stroke = stroke_of(job, name, part)
    return with_part(job, name, part, stroke[: len(stroke) // 2 + 1])


def a_crease_is_scored_twice_elsewhere(job: Job) -> Job:
    name, part = locate(job, Role.SCORE, Face.REVERSE)
    stroke = stroke_of(job, name, part)
    return with_part(job, name, part, stroke, "", stroke)


def a_hole_is_gone_round_once_more(job: Job) -> Job:
    name, part = locate(job, Role.HOLE, Face.FRONT, 2)
    ring = stroke_of(job, name, part)
    once = ring[: ring.index(ring[0], 1) + 1]
    return with_part(job, name, part, [*once, *ring[1:]])


def a_hole_is_closed_without_its_overcut(job: Job) -> Job:
    name, part = locate(job, Role.HOLE, Face.FRONT)
    ring = stroke_of(job, name, part)
    last = len(ring) - 1 - ring[::-1].index(ring[0])
    return with_part(job, name, part, ring[: last + 1])


def a_stroke_is_moved_by_a_twentieth_of_a_mm(job: Job) -> Job:
    name, part = locate(job, Role.SCORE, Face.REVERSE, 1)
    return with_part(job, name, part, [(x + 2, y) for x, y in stroke_of(job, name, part)])


def a_line_is_extra(job: Job) -> Job:
    name, part = locate(job, Role.SCORE, Face.FRONT)
    stroke = stroke_of(job, name, part)
    x, y = stroke[0]
    return with_part(job, name, part, stroke, [(x, y), (x + 300, y - 400)])


def a_tie_is_cut_through(job: Job) -> Job:
    name, part = locate(job, Role.CUT_OUTER, Face.REVERSE)
    one, two = stroke_of(job, name, part), stroke_of(job, name, part + 2)
    return with_part(job, name, part, [*one[: len(one) // 6 + 1], two[0]])


def a_score_is_lifted_before_it_is_repeated(job: Job) -> Job:
    return _lifted(job, Role.SCORE, Face.REVERSE)


def a_hole_is_cut_in_two_goes(job: Job) -> Job:
    return _lifted(job, Role.HOLE, Face.FRONT)


def _lifted(job: Job, role: Role, face: Face) -> Job:
    name, part = locate(job, role, face)
    stroke = stroke_of(job, name, part)
    half = len(stroke) // 2
    return with_part(job, name, part, stroke[: half + 1], "", stroke[half:])


def a_program_is_edited(job: Job) -> Job:
    name = files_of(job.plan)[0].name
    return Job(job.plan, job.pattern, {**job.programs, name: job.programs[name] + b"\n"})


def a_program_is_missing(job: Job) -> Job:
    name = files_of(job.plan)[-1].name
    kept = {other: data for other, data in job.programs.items() if other != name}
    return Job(job.plan, job.pattern, kept)


def _reworded(job: Job, pattern: str, new: str) -> Job:
    name, _ = locate(job, Role.SCORE, Face.REVERSE)
    return with_program(job, name, re.sub(pattern, new, job.programs[name].decode()).encode())


def the_tool_is_wrong(job: Job) -> Job:
    return _reworded(job, r"SP[1-9]", "SP3")


def the_speed_is_wrong(job: Job) -> Job:
    return _reworded(job, r"VS12", "VS13")


def the_force_is_wrong(job: Job) -> Job:
    return _reworded(job, r"FS240", "FS300")


PROGRAMS: dict[Callable[[Job], Job], str] = {
    a_stroke_is_missing: "missing-stroke",
    a_stroke_is_on_the_wrong_face: "wrong-face",
    the_reverse_is_not_mirrored: "not-mirrored",
    the_front_is_mirrored: "mirrored-front",
    everything_is_scaled_by_1021_to_1016: "scale",
    a_point_is_outside_the_range: "outside-range",
    a_point_is_beside_the_carrier: "outside-carrier",
    the_outline_is_cut_before_the_scores: "order",
    a_crease_is_cut_once_more: "repeats",
    a_crease_is_cut_once_less: "repeats",
    a_crease_is_scored_twice_elsewhere: "repeats",
    a_hole_is_gone_round_once_more: "repeats",
    a_hole_is_closed_without_its_overcut: "repeats",
    a_stroke_is_moved_by_a_twentieth_of_a_mm: "moved",
    a_line_is_extra: "extra-line",
    a_tie_is_cut_through: "extra-line",
    a_score_is_lifted_before_it_is_repeated: "lifted-within",
    a_hole_is_cut_in_two_goes: "lifted-within",
    a_program_is_edited: "edited",
    a_program_is_missing: "missing-program",
    the_tool_is_wrong: "wrong-tool",
    the_speed_is_wrong: "wrong-speed",
    the_force_is_wrong: "wrong-force",
}
"""What is done to the programs, and the finding that must name it."""
