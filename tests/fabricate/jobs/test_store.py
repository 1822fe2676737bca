"""Jobs in the store: submitted once, taken in order, changed by one hand, asked under spent ids."""

from __future__ import annotations

import shutil
from concurrent.futures import ThreadPoolExecutor
from itertools import pairwise

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from foldmill_fabricate.jobs import Desk, JobState, Kind, Reply, Submission
from foldmill_fabricate.jobs.asking import Asked
from foldmill_fabricate.jobs.errors import Clash, JobRefused, NoSuchJob
from foldmill_fabricate.jobs.states import FOLLOWS
from foldmill_fabricate.plotter.errors import Fenced


def submitted(desk: Desk, plan: str, **more: object) -> str:
    given = {"plan": plan, "plotter": "bench", **more}
    return desk.submit(Submission.model_validate(given)).id


def test_the_same_key_again_gives_the_job_that_is_there(desk: Desk, plan: str) -> None:
    assert submitted(desk, plan, key="k") == submitted(desk, plan, key="k")
    assert len(desk.jobs()) == 1


def test_a_key_is_not_taken_for_another_job(desk: Desk, plan: str) -> None:
    submitted(desk, plan, key="k")
    with pytest.raises(Clash, match="used before"):
        submitted(desk, plan, key="k", copies=2)


def test_many_who_submit_under_one_key_at_once_get_one_job(desk: Desk, plan: str) -> None:
    with ThreadPoolExecutor(8) as pool:
        names = set(pool.map(lambda _: submitted(desk, plan, key="k"), range(24)))
    assert len(names) == len(desk.jobs()) == 1


def test_a_plotter_gets_the_highest_priority_first_then_who_came_first(
    desk: Desk, plan: str
) -> None:
    first, second = submitted(desk, plan), submitted(desk, plan)
    urgent = submitted(desk, plan, priority=5)
    desk.prioritise(second, 1)
    order = []
    while (taken := desk.store.take("bench")) is not None:
        order.append(taken[0].id)
        desk.store.move(taken[0].id, taken[1], JobState.DONE)
    assert order == [urgent, second, first]


def test_a_plotter_that_has_a_job_gets_no_other(desk: Desk, plan: str) -> None:
    first = submitted(desk, plan)
    taken = desk.store.take("bench")
    submitted(desk, plan, priority=9)
    again = desk.store.take("bench")
    assert taken is not None
    assert again is not None
    assert taken[0].id == again[0].id == first
    assert again[1] > taken[1]


def test_a_hand_that_lost_its_job_changes_nothing_any_more(desk: Desk, plan: str) -> None:
    name = submitted(desk, plan)
    old, new = desk.store.take("bench"), desk.store.take("bench")
    assert old is not None
    assert new is not None
    for change in (
        lambda: desk.store.move(name, old[1], JobState.DONE),
        lambda: desk.store.begin_sheet(name, old[1], "ABCD"),
        lambda: desk.store.ask(old[1], Asked(name, Kind.TROUBLE, "?")),
    ):
        with pytest.raises(Fenced):
            change()
    assert desk.job(name).state is JobState.RUNNING


def test_a_question_takes_one_answer(desk: Desk, plan: str) -> None:
    name = submitted(desk, plan)
    _, token = desk.store.take("bench") or pytest.fail("nothing is due")
    asked = desk.store.ask(token, Asked(name, Kind.TROUBLE, "The cable is out."))
    assert desk.job(name).state is JobState.NEEDS_OPERATOR
    assert desk.job(name).note == "The cable is out."
    desk.answer(asked.id, Reply())
    with pytest.raises(Clash, match="answered already"):
        desk.answer(asked.id, Reply(ok=False))
    answered = desk.store.reply(asked.id)
    assert answered is not None
    assert answered[0].ok


def test_a_late_click_never_answers_the_next_question(desk: Desk, plan: str) -> None:
    name = submitted(desk, plan)
    _, token = desk.store.take("bench") or pytest.fail("nothing is due")
    late = desk.store.ask(token, Asked(name, Kind.TROUBLE, "first"))
    now = desk.store.ask(token, Asked(name, Kind.TROUBLE, "second"))
    with pytest.raises(Clash, match="withdrawn already"):
        desk.answer(late.id, Reply())
    assert desk.store.reply(now.id) is None
    assert [one.id for one in desk.questions(name)] == [now.id]


@pytest.mark.parametrize("verb", ["pause", "cancel"])
def test_a_job_that_waits_is_paused_and_ended_without_a_plotter(
    desk: Desk, plan: str, verb: str
) -> None:
    name = submitted(desk, plan)
    getattr(desk, verb)(name)
    assert desk.store.take("bench") is None
    if verb == "pause":
        desk.resume(name)
        assert desk.store.take("bench") is not None


def test_what_a_person_wants_of_a_job_at_its_plotter_waits_for_the_machine(
    desk: Desk, plan: str
) -> None:
    name = submitted(desk, plan)
    desk.store.take("bench")
    assert desk.pause(name).wish == "pause"
    assert desk.cancel(name).wish == "cancel"
    assert desk.pause(name).wish == "cancel", "an end is not taken back by a pause"
    assert desk.job(name).state is JobState.RUNNING


@pytest.mark.parametrize("verb", ["pause", "resume", "cancel"])
def test_an_ended_job_stays_as_it_is(desk: Desk, plan: str, verb: str) -> None:
    name = submitted(desk, plan)
    desk.cancel(name)
    with pytest.raises(JobRefused, match=f"Job {name} is cancelled"):
        getattr(desk, verb)(name)


def test_what_there_is_not_is_said_by_its_name(desk: Desk, plan: str) -> None:
    for call, words in (
        (lambda: desk.job("NOBODY"), "There is no job 'NOBODY'"),
        (lambda: desk.answer("f00", Reply()), "There is no question 'f00'"),
        (lambda: submitted(desk, "f" * 64), "There is no plan"),
        (lambda: submitted(desk, "../../etc/passwd"), "There is no plan"),
        (lambda: submitted(desk, plan, plotter="sofa"), "There are: bench, other"),
    ):
        with pytest.raises(NoSuchJob, match=words):
            call()


def test_a_plan_for_another_machine_is_not_taken(desk: Desk, plan: str) -> None:
    sofa = desk.plotters["bench"].model_copy(update={"machine": "hp-7475a"})
    desk.plotters = {"bench": sofa}
    with pytest.raises(JobRefused, match="planned for generic-hpgl-600, and bench is a hp-7475a"):
        submitted(desk, plan)


def test_events_tell_every_change_in_order(desk: Desk, plan: str) -> None:
    name = submitted(desk, plan)
    desk.pause(name, "Ada")
    desk.resume(name, "Ada")
    heard = desk.store.events()
    assert [one.state for one in heard] == [
        JobState.SUBMITTED,
        JobState.PAUSED,
        JobState.SUBMITTED,
    ]
    assert [one.who for one in heard][1:] == ["Ada", "Ada"]
    assert desk.store.events(after=heard[1].number) == heard[2:]


_VERBS = st.lists(
    st.sampled_from(["pause", "resume", "cancel", "take", "rest", "done", "ask"]), max_size=9
)


@given(_VERBS)
@settings(
    max_examples=40,
    deadline=None,
    suppress_health_check=[HealthCheck.function_scoped_fixture],
)
def test_whatever_is_said_in_any_order_a_state_follows_by_the_table(
    desk: Desk, plan: str, verbs: list[str]
) -> None:
    name, token = submitted(desk, plan), 0
    for verb in verbs:
        before = desk.job(name).state
        try:
            if verb == "take":
                taken = desk.store.take("bench")
                token = taken[1] if taken and taken[0].id == name else token
            elif verb == "rest":
                desk.store.move(name, token, JobState.PAUSED)
            elif verb == "done":
                desk.store.move(name, token, JobState.DONE)
            elif verb == "ask":
                desk.store.ask(token, Asked(name, Kind.LOAD, "Load."))
            else:
                getattr(desk, verb)(name)
        except (JobRefused, Fenced):
            assert desk.job(name).state is before
    for one, other in pairwise(desk.store.events(job=name)):
        assert other.state is one.state or other.state in FOLLOWS[one.state]
    if not desk.job(name).is_ended:
        desk.cancel(name)
        _end(desk, name)


def _end(desk: Desk, name: str) -> None:
    """Leave the plotter free for the next example."""
    if not desk.job(name).is_ended:
        _, token = desk.store.take("bench") or pytest.fail("nothing is due")
        desk.store.move(name, token, JobState.CANCELLED)


def test_a_pause_that_is_heard_between_two_steps_of_the_work_stops_none_of_them(
    desk: Desk, plan: str
) -> None:
    name = submitted(desk, plan)
    _, token = desk.store.take("bench") or pytest.fail("nothing is due")
    desk.store.move(name, token, JobState.PAUSED)
    asked = desk.store.ask(token, Asked(name, Kind.FINISHED, "Is it?"))
    assert desk.job(name).state is JobState.WAITING
    desk.answer(asked.id, Reply())
    desk.store.move(name, token, JobState.RUNNING)
    desk.store.move(name, token, JobState.PAUSED)
    desk.store.move(name, token, JobState.DONE)
    assert desk.job(name).is_ended


def test_a_pause_is_not_taken_back_from_a_job_that_is_to_be_ended(desk: Desk, plan: str) -> None:
    name = submitted(desk, plan)
    _, token = desk.store.take("bench") or pytest.fail("nothing is due")
    desk.store.move(name, token, JobState.PAUSED)
    desk.cancel(name)
    with pytest.raises(JobRefused, match="cannot be resumed"):
        desk.resume(name)


@pytest.mark.parametrize("wanted", [1001, -1001, 10**30])
def test_a_priority_has_its_limits_whoever_gives_it(desk: Desk, plan: str, wanted: int) -> None:
    name = submitted(desk, plan)
    with pytest.raises(JobRefused, match="between -1000 and 1000"):
        desk.prioritise(name, wanted)


def test_a_job_whose_plan_is_gone_can_still_be_answered(desk: Desk, plan: str) -> None:
    name = submitted(desk, plan)
    _, token = desk.store.take("bench") or pytest.fail("nothing is due")
    shutil.rmtree(desk.plans.folder(plan))
    asked = desk.store.ask(token, Asked(name, Kind.TROUBLE, "There is no plan here."))
    desk.answer(asked.id, Reply(ok=False), "Ada")
    told = desk.history(name)[-1]
    assert (told.who, told.what) == ("Ada", "answered: trouble: no")


def test_the_history_says_what_was_answered(desk: Desk, plan: str) -> None:
    name = submitted(desk, plan)
    _, token = desk.store.take("bench") or pytest.fail("nothing is due")
    said = Reply(word="go on", stroke=3, vertex=2)
    desk.store.answer(desk.store.ask(token, Asked(name, Kind.DECIDE, "?")).id, said)
    assert desk.history(name)[-1].what == "answered: decide: go on, stroke 3, vertex 2"


def test_a_job_whose_plotter_is_gone_ends_when_a_person_says_so(desk: Desk, plan: str) -> None:
    name = submitted(desk, plan)
    desk.store.take("bench")
    assert not any(job.is_abandoned(["other"]) for job in desk.store.standing())
    desk.cancel(name)
    assert not any(job.is_abandoned(["bench", "other"]) for job in desk.store.standing())
    assert [job.id for job in desk.store.standing() if job.is_abandoned(["other"])] == [name]
    desk.store.end_abandoned(name)
    assert desk.job(name).state is JobState.CANCELLED
    assert "bench is no longer there" in desk.job(name).note
