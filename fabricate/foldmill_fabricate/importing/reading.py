"""From a file or its bytes to a fold, by the reader that knows it."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace
from pathlib import Path

from foldmill import Assignment, Fold, installed
from foldmill.errors import InvalidPattern, UnreadableFile
from foldmill.exchange.assembling import fold_of
from foldmill.exchange.limits import DEFAULT, Limits
from foldmill.exchange.options import Options
from foldmill.exchange.scaling import is_known
from foldmill.exchange.turning import turned
from foldmill.finding import Finding, Severity
from foldmill_fabricate.hooks import READERS, Reader, Sized

_HEAD = 4096
"""Bytes by which a format is told."""
_AS_IT_IS = Options()
_PIXELS = "a picture of pixels", "Draw its lines anew in a drawing program, and save them as SVG."
_OTHERS = {
    b"%PDF": ("a PDF, as .ai files are too", "Open it in a drawing program and save it as SVG."),
    b"%!PS": ("PostScript", "Open it in a drawing program and save it as SVG."),
    b"\x89PNG": _PIXELS,
    b"\xff\xd8\xff": _PIXELS,
    b"GIF8": _PIXELS,
    b"AC10": ("a DWG", "Save it as DXF."),
    b"\x1f\x8b": ("compressed, as .svgz files are", "Save it as plain SVG."),
    b"PK\x03\x04": ("an archive", "Unpack it first."),
}
"""By how they begin: what it is, and what to do."""


@dataclass(frozen=True)
class Question:
    """What cannot be known of a file, and the option that answers it."""

    option: str
    """Its name on the command line, as "--width"."""
    sentence: str
    blocks_plan: bool = True
    """Whether nothing can be made before it is answered."""


@dataclass(frozen=True)
class Imported:
    """A fold read from somebody's file."""

    fold: Fold
    """Its findings tell what was changed and supposed."""
    format: str
    """Slug of the reader."""
    questions: tuple[Question, ...] = ()


def read_pattern(
    source: Path | bytes,
    options: Options = _AS_IT_IS,
    *,
    name: str = "",
    limits: Limits = DEFAULT,
) -> Imported:
    """Return the fold in a file of any format that is read.

    source : the file, or its bytes; name : what to call it in sentences, whose suffix says its
    format; without a suffix that is known, its content does. Raises UnreadableFile for whatever
    cannot be read, OSError where there is no such file.
    """
    title = name or (str(source) if isinstance(source, Path) else "the file")
    try:
        content = _content(source, limits)
        reader = _reader(Path(title).suffix.lower(), content[:_HEAD])
        fold, is_sized = _read(reader, content, options, limits)
        fold = _called(fold, reader, source)
    except (UnreadableFile, InvalidPattern) as error:
        raise UnreadableFile(f"{title}: {error}") from None
    fold = turned(fold, back=options.side == "back", mirror=options.mirror)
    questions = tuple(_questions(fold, is_sized))
    asked = (_as_finding(question) for question in questions if question.blocks_plan)
    told = replace(fold, findings=(*fold.findings, *asked))
    return Imported(told, reader.slug, questions)


def suffixes() -> tuple[str, ...]:
    """Return the suffixes of all files that are read, sorted."""
    readers: Mapping[str, Reader] = installed().of(READERS)
    return tuple(sorted({suffix for reader in readers.values() for suffix in reader.suffixes}))


def _content(source: Path | bytes, limits: Limits) -> bytes:
    if isinstance(source, bytes):
        limits.check_size(len(source))
        return source
    with source.open("rb") as file:
        content = file.read(limits.size + 1)
    limits.check_size(len(content))
    return content


def _reader(suffix: str, head: bytes) -> Reader:
    readers: list[Reader] = list(installed().of(READERS).values())
    if not head.strip():
        raise UnreadableFile("This file is empty.")
    _refuse_other(head)
    for reader in readers:
        if suffix in reader.suffixes:
            return reader
    for reader in readers:
        if reader.recognises is not None and reader.recognises(head):
            return reader
    raise UnreadableFile(
        f"This is no crease pattern that can be read. Those that can: {', '.join(suffixes())}."
    )


def _refuse_other(head: bytes) -> None:
    """Refuse what is known to be something else, saying how to make it what can be read."""
    for mark, (what, remedy) in _OTHERS.items():
        if head.startswith(mark):
            raise UnreadableFile(f"This is {what}, whatever it is called. {remedy}")


def _read(reader: Reader, content: bytes, options: Options, limits: Limits) -> tuple[Fold, bool]:
    found = reader.read(content, options, limits)
    if isinstance(found, Sized):
        return found.fold, found.is_sized
    return _with_side(fold_of(found, options, limits), options), is_known(
        found.millimetres, options
    )


def _called(fold: Fold, reader: Reader, source: Path | bytes) -> Fold:
    """Call a drawing without a title by its file, so that its sheets and papers have a name."""
    if fold.meta.get("title") or reader.slug == "fold" or isinstance(source, bytes):
        return fold
    return replace(fold, meta={**fold.meta, "title": source.stem})


def _with_side(fold: Fold, options: Options) -> Fold:
    """Say of a drawing, which does not know faces, which one it was taken to show."""
    if options.side == "back":
        return fold
    message = "The drawing is taken to show the front of the sheet."
    remedy = "If it shows the back, say --side back; if it is a mirror image, --mirror."
    finding = Finding("import-side", Severity.INFO, "", message, remedy)
    return replace(fold, findings=(*fold.findings, finding))


def _questions(fold: Fold, is_sized: bool) -> Iterable[Question]:
    if not is_sized:
        size = fold.pattern.vertices.max(axis=0) - fold.pattern.vertices.min(axis=0)
        yield Question(
            "--width",
            f"The file does not say how large it is: {size[0]:.6g} × {size[1]:.6g} of a unit of "
            f"its own. Say --width MM of the pattern, or what a unit is by --unit or --scale.",
        )
    open_ = fold.pattern.count(Assignment.U)
    if open_:
        yield Question(
            "--unassigned",
            f"{open_} creases are neither mountain nor valley. Say --unassigned front, reverse or "
            f"skip.",
            blocks_plan=False,  # planning asks for it by itself
        )


def _as_finding(question: Question) -> Finding:
    return Finding("import-size", Severity.WARNING, "", question.sentence)


def require_answers(imported: Imported, name: str) -> None:
    """Raise UnreadableFile where nothing can be made before a question is answered."""
    for question in imported.questions:
        if question.blocks_plan:
            raise UnreadableFile(f"{name}: {question.sentence}")
