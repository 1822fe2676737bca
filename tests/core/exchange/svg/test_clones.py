"""What clones and symbols show is what is read, as if it were drawn there; and no bomb of them."""

from __future__ import annotations

import random

import numpy as np
import pytest

from foldmill import UnreadableFile
from foldmill.exchange import svg
from foldmill.exchange.drawing import Drawing
from foldmill.exchange.limits import Limits

HEAD = (
    '<svg xmlns="http://www.w3.org/2000/svg" xmlns:xlink="http://www.w3.org/1999/xlink" '
    'xmlns:inkscape="x">{}</svg>'
)
FORK = '<g id="fork"><path d="M0 0L10 0"/><line x1="10" y1="0" x2="15" y2="5" stroke="blue"/></g>'
DEFS = f'<defs><g stroke="lime">{FORK}</g></defs>'


def drawn(body: str, limits: Limits | None = None) -> Drawing:
    return svg.read(HEAD.format(body).encode(), limits or Limits())


def seen(body: str) -> list[tuple[list[float], str]]:
    found = drawn(body)
    ends = found.segments.reshape(-1, 4).round(9).tolist()
    return [(line, look.hex) for line, look in zip(ends, found.looks, strict=True)]


@pytest.mark.parametrize("link", ["href", "xlink:href"])
def test_a_clone_stands_where_it_is_moved_and_inherits_from_its_own_group(link: str) -> None:
    use = f'<g stroke="red"><use {link}="#fork" x="2" y="3" transform="scale(2)"/></g>'
    assert seen(DEFS + use) == [([4, 6, 24, 6], "#ff0000"), ([24, 6, 34, 16], "#0000ff")]


def test_a_clone_of_what_is_drawn_is_there_twice_and_in_its_own_layer() -> None:
    body = (
        '<g inkscape:label="valleys"><path id="p" d="M0 0H9" stroke="red"/></g>'
        '<g inkscape:label="mountains"><use href="#p" y="5"/></g>'
    )
    found = drawn(body)
    assert found.segments.tolist() == [[[0, 0], [9, 0]], [[0, 5], [9, 5]]]
    assert [look.layers for look in found.looks] == [("valleys", "p"), ("mountains", "p")]


def test_clones_of_clones_are_what_they_would_be_drawn_out() -> None:
    chance = random.Random(3)
    made = '<path id="n0" d="M0 0L10 0L10 7"/>'
    whole = '<path d="M0 0L10 0L10 7"/>'
    for k in range(1, 6):
        moves = [
            f"translate({chance.uniform(-9, 9):.3f} 4) rotate({chance.uniform(0, 360):.3f})"
            for _ in range(2)
        ]
        xs = [round(chance.uniform(-5, 5), 3) for _ in moves]
        uses = (
            f'<use href="#n{k - 1}" x="{x}" transform="{m}"/>'
            for x, m in zip(xs, moves, strict=True)
        )
        copies = (
            f'<g transform="{m} translate({x} 0)">{whole}</g>'
            for x, m in zip(xs, moves, strict=True)
        )
        made += f'<g id="n{k}">{"".join(uses)}</g>'
        whole = f"<g>{''.join(copies)}</g>"
    one = drawn(f'<defs>{made}</defs><use href="#n5" stroke="red"/>')
    two = drawn(f'<g stroke="red">{whole}</g>')
    assert len(one.segments) == 2 * 2**5
    assert np.allclose(one.segments, two.segments, atol=1e-9)


def test_a_symbol_is_as_large_as_it_is_used() -> None:
    symbol = '<symbol id="s" viewBox="-9 -9 18 18"><path d="M-9 0H9" stroke="red"/></symbol>'
    use = '<use href="#s" width="36" height="36" x="-18" y="-18" transform="translate(50 60)"/>'
    assert seen(symbol + use) == [([32, 60, 68, 60], "#ff0000")]
    bare = '<symbol id="s"><path d="M-9 0H9" stroke="red"/></symbol><use href="#s" y="1"/>'
    assert seen(bare) == [([-9, 1, 9, 1], "#ff0000")]


def test_a_symbol_of_no_known_size_is_refused() -> None:
    symbol = '<symbol id="s" viewBox="0 0 18 18"><path d="M0 0H9" stroke="red"/></symbol>'
    with pytest.raises(UnreadableFile, match="<symbol>"):
        drawn(symbol + '<use href="#s"/>')


def test_hidden_clones_are_not_drawn_and_styles_by_class_are() -> None:
    style = "<style>.st0{stroke:#0000ff} .off{display:none}</style>"
    line = '<defs><path id="p" class="st0" d="M0 0H9"/></defs>'
    uses = '<use href="#p"/><use href="#p" class="off"/><use href="#p" visibility="hidden"/>'
    assert seen(style + line + uses) == [([0, 0, 9, 0], "#0000ff")]


def test_of_a_switch_one_child_is_drawn() -> None:
    # As Adobe's programs write it: what only they understand, and what all others show.
    body = (
        '<switch><foreignObject requiredExtensions="http://ns.adobe.com/AdobeIllustrator/10.0/" '
        'width="1" height="1"/><g><path d="M0 0H9" stroke="red"/></g></switch>'
        '<switch><path systemLanguage="de" d="M0 1H9" stroke="red"/>'
        '<path d="M0 2H9" stroke="red"/><path d="M0 3H9" stroke="red"/></switch>'
    )
    assert [line for line, _ in seen(body)] == [[0, 0, 9, 0], [0, 2, 9, 2]]


@pytest.mark.parametrize(
    ("body", "said"),
    [
        ('<use href="other.svg#a"/>', "from another file"),
        ('<use href="#nowhere"/>', "which is not in it"),
        ("<use/>", "which is not in it"),
        ('<g id="a"><use href="#a"/></g>', "set into itself"),
        ('<g id="a"><use href="#b"/></g><g id="b"><use href="#a"/></g>', "set into itself"),
        ('<use id="a" href="#a"/>', "set into itself"),
    ],
)
def test_clones_that_lead_nowhere_are_refused(body: str, said: str) -> None:
    with pytest.raises(UnreadableFile, match=said) as refused:
        drawn(body + '<path d="M0 0H9" stroke="red"/>')
    assert "Unlink Clones" in str(refused.value)


def laughs(inner: str, levels: int = 12) -> str:
    """Ten clones of ten clones of ten clones …"""
    made = f'<g id="n0">{inner}</g>'
    for k in range(1, levels):
        made += f'<g id="n{k}">' + f'<use href="#n{k - 1}"/>' * 10 + "</g>"
    return f'<defs>{made}</defs><use href="#n{levels - 1}" stroke="red"/>'


@pytest.mark.parametrize(
    "inner", ["", '<path d="M0 0H9"/>', '<path d="M0 0H9" stroke="none"/>', "<text/>"]
)
def test_a_billion_laughs_are_cut_short(inner: str) -> None:
    with pytest.raises(UnreadableFile, match="more than"):
        drawn(laughs(inner), Limits(elements=20_000, lines=5000))


def test_a_chain_of_clones_is_no_deeper_than_elements_may_be() -> None:
    def chain(length: int) -> str:
        links = (f'<g id="n{k}"><use href="#n{k - 1}"/></g>' for k in range(1, length))
        first = '<path id="n0" d="M0 0H9" stroke="red"/>'
        return f'<defs>{first}{"".join(links)}</defs><use href="#n{length - 1}"/>'

    assert len(drawn(chain(90)).segments) == 1
    with pytest.raises(UnreadableFile, match="200 deep"):
        drawn(chain(5000))


def test_clones_under_a_thousand_selectors_are_read_in_one_go() -> None:
    rules = "".join(f".a{k}.b{k}{{stroke:red}}" for k in range(900))
    uses = '<use href="#p"/>' * 5000
    line = '<defs><path id="p" d="M0 0H9" class="a1 b1"/></defs>'
    assert len(drawn(f"<style>{rules}</style>{line}{uses}").segments) == 5000
