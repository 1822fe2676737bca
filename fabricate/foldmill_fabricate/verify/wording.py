"""What each kind of finding is called, and what to do about it where the finding does not say."""

from __future__ import annotations

_PLAN = "Plan again into this folder; the plan is not edited by hand."
_WRITE = "Plan again into this folder; programs are neither edited, renamed nor mixed."
_REST = "Plan the rest of the sheet again, with foldmill sheets ID --remake."
_SETTINGS = "Plan again with the material and the machine that are used."

KINDS: dict[str, tuple[str, str]] = {
    "blade-unsettled": ("The blade does not point one way after its lead-in", _PLAN),
    "blank-off-carrier": ("The blank sticks out of its carrier", "Plan with a larger --carrier."),
    "carrier-too-large": ("The carrier is larger than the machine", "Plan with a smaller one."),
    "cut-depth": ("The outline is cut to the wrong depth", _SETTINGS),
    "cut-twice": ("Something is cut twice", _PLAN),
    "dash-in-corner": ("A row of cuts reaches into a corner, where it tears", _PLAN),
    "dip": ("The tool pierces the sheet and draws nothing", _WRITE),
    "edited": ("A file was changed after planning", _WRITE),
    "extra-line": ("A line is drawn that the plan does not have", _WRITE),
    "flip-axis": ("The sheet is not turned over about its middle", _PLAN),
    "hole-clearance": ("A registration hole is too near to something", _PLAN),
    "lifted-within": ("The tool is lifted in the middle of a stroke", _WRITE),
    "lead-in-missing": ("Nobody knows how the blade points", _WRITE),
    "lead-in-on-part": ("A lead-in is cut into the part", _PLAN),
    "lead-in-place": ("A lead-in is too near to something", _PLAN),
    "lead-in-short": ("A lead-in does not turn every blade", _PLAN),
    "missing-cut": ("The outline or an inner cut is not cut", _PLAN),
    "missing-gate": ("The operator is not asked to do something", _PLAN),
    "missing-program": ("A program is missing", _WRITE),
    "missing-score": ("A crease is not scored", _PLAN),
    "missing-stroke": ("A stroke of the plan is not drawn", _WRITE),
    "moved": ("A stroke lies beside its place", _WRITE),
    "no-pattern": ("There is no pattern to prove it against", ""),
    "no-such-line": ("The plan has a line that the pattern does not have", _PLAN),
    "not-to-score": ("A line is scored that is no fold", _PLAN),
    "order": ("The work is done in the wrong order", _WRITE),
    "outside-blank": ("A line leaves the blank", _PLAN),
    "outside-carrier": ("A program leaves the carrier", _WRITE),
    "outside-range": ("A program leaves the range of the machine", _WRITE),
    "overcut-on-score": ("A score runs on past its end", _PLAN),
    "part-clearance": ("The part is too near to the blank's edge", "Plan with a larger --blank."),
    "remake-origin": ("The plan that a sheet was begun from was changed", _REST),
    "remake-setting": ("What is left of a sheet is planned otherwise than it was begun", _REST),
    "remake-stroke": ("What is planned is not what is left of the sheet", _REST),
    "remake-there": ("What is said to be on the sheet is not in its plan", _REST),
    "repeats": ("A stroke is repeated too often or too rarely", _WRITE),
    "score-depth": ("Scores are cut to the wrong depth", _SETTINGS),
    "scored-on-both": ("A crease is scored on both faces", _PLAN),
    "scored-twice": ("A crease is scored twice", _PLAN),
    "set-up-values": ("A set-up is not what material and machine ask for", _SETTINGS),
    "setback": ("A score runs into the corner it must stop short of", _PLAN),
    "stroke-order": ("Strokes are drawn in another order than planned", ""),
    "swivel-astray": ("A blade that is only to be turned draws a line", _WRITE),
    "swivel-missing": ("The blade is turned in thick material, where it may break", _WRITE),
    "syntax": ("A program cannot be read", _WRITE),
    "tie-astray": ("A tie does not lie on the outline", _PLAN),
    "tie-corner": ("A tie is in a corner", _PLAN),
    "tie-cut": ("A tie is cut through", _PLAN),
    "ties-bunched": ("Ties hold the part on one side only", _PLAN),
    "too-few-ties": ("Too few ties hold the part", _PLAN),
    "unknown-instruction": ("A program holds an unknown instruction", _WRITE),
    "witness-missing": ("Nothing shows whether the sheet was turned over", _PLAN),
    "witness-on-part": ("The witness mark is cut into the part", _PLAN),
    "witness-symmetric": ("The witness mark looks alike whichever way it lies", _PLAN),
    "wrong-face": ("Something is made on the wrong face", _WRITE),
    "wrong-force": ("A program sets another force", _WRITE),
    "wrong-gate": ("The operator is asked to do something wrong", _PLAN),
    "wrong-process": ("Something is made in the wrong way", _PLAN),
    "wrong-set-up": ("A program does the work of another", _WRITE),
    "wrong-speed": ("A program sets another speed", _WRITE),
    "wrong-tool": ("A program takes another tool", _WRITE),
}
"""By code: a title, and a remedy."""


def title(code: str) -> str:
    """Return what a kind of finding is called; its code in words where it has no name."""
    words = code.replace("-", " ")
    return KINDS.get(code, (words[:1].upper() + words[1:], ""))[0]


def remedy(code: str) -> str:
    """Return what to do about a kind of finding; empty where nobody has said."""
    return KINDS.get(code, ("", ""))[1]
