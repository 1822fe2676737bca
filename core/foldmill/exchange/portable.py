"""FOLD as particular programs want it: the pattern in one frame, and nothing they stumble over.

``write`` gives a file that loses nothing; these give files that a program is known to accept. They
hold fewer keys, and none of our own. What a program cannot hold at all is no matter of spelling:
who offers these files has to say so.
"""

from __future__ import annotations

from foldmill.design import Fold
from foldmill.exchange import json_text
from foldmill.exchange.fold import pattern_alone
from foldmill.exchange.json_text import Frame
from foldmill.exchange.keys import JOIN
from foldmill.exchange.marking import warning

_FLAT = {"M": -180, "V": 180}
"""deg. The angles of a program that folds every crease flat."""


def spatial(fold: Fold) -> str:
    """Return FOLD for simulators that take two coordinates for a floor seen from below.

    Origami Simulator puts x, y at x, 0, y and so shows the reverse: with z written out it stands up
    and shows its front. Inner cuts are two boundaries each; all angles are numbers.
    """
    data = pattern_alone(fold)
    data["vertices_coords"] = [[*place, 0] for place in data["vertices_coords"]]
    return _dump(fold, data)


def flat(fold: Fold) -> str:
    """Return FOLD for programs that know creases folded flat only: by 180 degrees, or not at all.

    Edges name their lower vertex first, as Flat-Folder's own files do.
    """
    return _dump(fold, _closed(pattern_alone(fold)))


def downward(fold: Fold) -> str:
    """Return FOLD for editors that draw y downward and take a file's y as it is, as Oriedita does.

    What is up on the sheet is up on their screen: y runs down from 0 at the top. Creases are folded
    flat. Faces are left out, for they would be seen from behind; such editors find their own.
    """
    data = _closed(pattern_alone(fold))
    places = data["vertices_coords"]
    left, top = min(x for x, _ in places), max(y for _, y in places)
    data["vertices_coords"] = [[x - left, top - y] for x, y in places]
    del data["faces_vertices"]
    return _dump(fold, data)


def _closed(data: Frame) -> Frame:
    data["edges_vertices"] = [sorted(edge) for edge in data["edges_vertices"]]
    data["edges_foldAngle"] = [_FLAT.get(letter, 0) for letter in data["edges_assignment"]]
    return data


def plain(fold: Fold) -> str:
    """Return FOLD for libraries that check it: every array consistent, no letter but B M V F U."""
    return _dump(fold, pattern_alone(fold))


def strict(fold: Fold) -> str:
    """Return FOLD by the letter of its version 1.2: inner cuts are C and joins J.

    Few programs read these letters, so this is for those that ask for them.
    """
    data = pattern_alone(fold, opened=False)
    joins = fold.meta.get("fold", {}).get("frame", {}).get(JOIN, [])
    letters = data["edges_assignment"]
    if len(joins) == len(letters):
        data["edges_assignment"] = [
            "J" if joined and letter == "F" else letter
            for joined, letter in zip(joins, letters, strict=True)
        ]
    said = {"C": ("noCuts", "cuts"), "J": ("noJoins", "joins")}
    found = {said[letter] for letter in "CJ" if letter in data["edges_assignment"]}
    data["frame_attributes"] = [dict(found).get(each, each) for each in data["frame_attributes"]]
    return _dump(fold, data)


def _dump(fold: Fold, data: Frame) -> str:
    told = warning(fold)
    return json_text.dump({**data, **({"frame_description": told} if told else {})})
