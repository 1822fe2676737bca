"""Yes-or-no questions that must be answered together: a search that draws every consequence."""

from __future__ import annotations

from collections import deque
from dataclasses import dataclass
from enum import Enum

_MOST_TRIES = 20_000
"""Guesses after which the search gives up."""


class Verdict(Enum):
    """How a search ended."""

    FOUND = 1
    NONE = 2
    OPEN = 3
    """It was given up."""


@dataclass(frozen=True)
class Rule:
    """Some questions, and every way in which they may be answered together."""

    questions: tuple[int, ...]
    allowed: frozenset[tuple[bool, ...]]
    blamed: int
    """Whom to name where the rule cannot be kept; -1 for nobody."""


@dataclass(frozen=True)
class Result:
    """The end of a search."""

    verdict: Verdict
    answers: tuple[bool, ...] = ()
    """One for each question, where they were found."""
    blamed: int = -1
    """Whom the rule names that broke most often, where there are none."""


class Search:
    """Find answers to all questions that keep all rules, or show that there are none."""

    def __init__(self, count: int, rules: list[Rule]) -> None:
        self.rules = rules
        self.answers: list[bool | None] = [None] * count
        self.about: list[list[int]] = [[] for _ in range(count)]
        for number, rule in enumerate(rules):
            for question in rule.questions:
                self.about[question].append(number)
        self.trail: list[int] = []
        self.broken: dict[int, int] = {}

    def run(self) -> Result:
        """Return the answers, or who is to blame; deterministic."""
        if not self._draw(range(len(self.rules))):
            return self._none()
        guesses: list[tuple[int, int, bool]] = []
        for _ in range(_MOST_TRIES):
            question = self._next()
            if question is None:
                return Result(Verdict.FOUND, tuple(bool(each) for each in self.answers))
            guesses.append((question, len(self.trail), False))
            if self._say(question, True):
                continue
            if not self._back(guesses):
                return self._none()
        return Result(Verdict.OPEN)

    def _back(self, guesses: list[tuple[int, int, bool]]) -> bool:
        """Take back guesses until one goes the other way; tell whether any does."""
        while guesses:
            question, length, is_second = guesses.pop()
            while len(self.trail) > length:
                self.answers[self.trail.pop()] = None
            if not is_second:
                guesses.append((question, length, True))
                if self._say(question, False):
                    return True
        return False

    def _next(self) -> int | None:
        """Return the open question that most rules are about."""
        open_ = [k for k, answer in enumerate(self.answers) if answer is None]
        return max(open_, key=lambda k: (len(self.about[k]), -k), default=None)

    def _say(self, question: int, answer: bool) -> bool:
        self.answers[question] = answer
        self.trail.append(question)
        return self._draw(self.about[question])

    def _draw(self, first: range | list[int]) -> bool:
        """Draw all consequences; tell whether every rule can still be kept."""
        waiting, queued = deque(first), set(first)
        while waiting:
            number = waiting.popleft()
            queued.discard(number)
            rule = self.rules[number]
            known = [self.answers[question] for question in rule.questions]
            left = [
                each
                for each in rule.allowed
                if all(k is None or k == a for k, a in zip(known, each, strict=True))
            ]
            if not left:
                self.broken[rule.blamed] = self.broken.get(rule.blamed, 0) + 1
                return False
            for k, question in enumerate(rule.questions):
                values = {each[k] for each in left}
                if known[k] is None and len(values) == 1:
                    self.answers[question] = values.pop()
                    self.trail.append(question)
                    more = [n for n in self.about[question] if n not in queued]
                    waiting.extend(more)
                    queued.update(more)
        return True

    def _none(self) -> Result:
        named = {who: count for who, count in self.broken.items() if who >= 0}
        blamed = max(sorted(named), key=lambda who: named[who], default=-1)
        return Result(Verdict.NONE, blamed=blamed)
