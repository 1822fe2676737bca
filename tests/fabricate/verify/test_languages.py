"""Programs are replayed by the interpreter of their language."""

from __future__ import annotations

import pytest
import stools

from foldmill import UnknownName
from foldmill_fabricate.verify.languages import INTERPRETERS, replay


def test_hp_gl_is_interpreted() -> None:
    trace = replay(b"IN;DF;PA;PU;SP1;PU10,20;PD30,20;PU;SP0;", "one.hpgl", stools.machine())
    (run,) = trace.runs
    assert run.points.tolist() == [[10, 20], [30, 20]]
    assert trace.findings == ()


def test_a_language_that_nobody_interprets_is_refused_with_those_there_are() -> None:
    machine = stools.machine().model_copy(update={"language": "semaphore"})
    with pytest.raises(UnknownName, match="semaphore"):
        replay(b"", "one.txt", machine)
    assert set(INTERPRETERS) == {"hpgl"}
