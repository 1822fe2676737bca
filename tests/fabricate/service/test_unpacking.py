"""A ZIP file from a stranger ends as files of a folder, or as a sentence; never as a fault."""

from __future__ import annotations

import io
import random
import zipfile
from collections.abc import Iterator
from pathlib import Path

import httpx
import pytest

from foldmill.errors import UnreadableFile
from foldmill_fabricate.service.unpacking import unpack

UPLOAD = {"content-type": "application/octet-stream", "x-foldmill": "1"}
WAYS = [zipfile.ZIP_STORED, zipfile.ZIP_DEFLATED, zipfile.ZIP_BZIP2, zipfile.ZIP_LZMA]
FILES = {"plan.json": b"{}" * 300, "1-front.hpgl": b"PU0,0;" * 200, "pattern.fold": b"[]"}


def packed(way: int) -> bytes:
    made = io.BytesIO()
    with zipfile.ZipFile(made, "w", way) as out:
        for name, content in FILES.items():
            out.writestr(name, content)
    return made.getvalue()


def garbled(whole: bytes, chance: random.Random) -> bytes:
    """Change some bytes, mostly of the headers at the end, and cut off some ends."""
    made = bytearray(whole)
    for _ in range(chance.randint(1, 8)):
        near_end = chance.random() < 0.6
        place = len(made) - 1 - chance.randrange(260) if near_end else chance.randrange(len(made))
        made[place] = chance.choice([0, 1, 255, chance.randrange(256)])
    return bytes(made[: chance.randrange(len(made))] if chance.random() < 0.1 else made)


def folders(place: Path) -> Iterator[Path]:
    yield from (place / str(number) for number in range(10_000))


@pytest.mark.parametrize("way", WAYS)
def test_garbled_files_are_read_or_refused_with_a_sentence(tmp_path: Path, way: int) -> None:
    chance, whole, refused = random.Random(way), packed(way), 0
    upload = tmp_path / "upload"
    for folder, _ in zip(folders(tmp_path), range(300), strict=False):
        upload.write_bytes(garbled(whole, chance))
        try:
            unpack(upload, folder)
        except UnreadableFile:
            refused += 1
    assert refused > 200


def test_what_unpacks_a_thousandfold_in_unusual_ways_is_refused(tmp_path: Path) -> None:
    for number, way in enumerate(WAYS[2:]):
        (tmp_path / "upload").write_bytes(packed(way))
        with pytest.raises(UnreadableFile, match="packed in an unusual way; use deflate"):
            unpack(tmp_path / "upload", tmp_path / str(number))


def test_no_refusal_tells_where_it_lay_on_the_disk(service: httpx.Client) -> None:
    made = io.BytesIO()
    with zipfile.ZipFile(made, "w") as out:
        out.writestr("plan.json", b"{}")
    answer = service.post("/api/v1/plans/kept", content=made.getvalue(), headers=UPLOAD)
    assert answer.status_code == 422
    assert answer.json()["detail"].startswith("job/"), answer.text
