"""Tiles with captions, and text on a card: the plain means that the other pictures share."""

import textwrap
from collections.abc import Sequence

import cv2
import numpy as np
from numpy.typing import NDArray

Picture = NDArray[np.uint8]  # (H, W, 3) RGB
Colour = tuple[int, int, int]

PAPER: Colour = (250, 249, 246)
INK: Colour = (38, 42, 48)
FONT = cv2.FONT_HERSHEY_SIMPLEX


def resized(picture: Picture, width: int) -> Picture:
    """``picture`` scaled to ``width`` pixels."""
    height = max(1, round(picture.shape[0] * width / picture.shape[1]))
    return cv2.resize(picture, (width, height), interpolation=cv2.INTER_AREA).astype(np.uint8)


def put_text(picture: Picture, text: str, at: tuple[int, int], scale: float = 0.45, colour: Colour = INK) -> None:
    """Write one line (baseline's left end ``at`` x, y) into ``picture``, in place; what is not ASCII becomes '?'."""
    plain = text.encode("ascii", "replace").decode()
    cv2.putText(picture, plain, at, FONT, scale, colour, 1, cv2.LINE_AA)


def contact_sheet(pictures: Sequence[Picture], captions: Sequence[str], columns: int, width: int) -> Picture:
    """Pictures in rows of ``columns``, each ``width`` wide with its caption below; all must have one aspect ratio."""
    if not pictures:
        return text_card("nothing to show", [], width * columns)
    tiles = [resized(p, width) for p in pictures]
    height, caption, gap = max(t.shape[0] for t in tiles), 18, 4
    rows = -(-len(tiles) // columns)
    sheet = np.full((rows * (height + caption + gap) + gap, columns * (width + gap) + gap, 3), PAPER, np.uint8)
    for i, (tile, text) in enumerate(zip(tiles, captions, strict=True)):
        x, y = gap + (i % columns) * (width + gap), gap + (i // columns) * (height + caption + gap)
        sheet[y : y + tile.shape[0], x : x + width] = tile
        put_text(sheet, text, (x + 2, y + height + 13), 0.38)
    return sheet


def text_card(title: str, paragraphs: Sequence[str], width: int = 720) -> Picture:
    """A page of text: a title, then paragraphs wrapped to ``width`` pixels."""
    lines = [line for p in paragraphs for line in [*textwrap.wrap(p, max(20, (width - 32) // 8)), ""]]
    card = np.full((52 + 19 * len(lines), width, 3), PAPER, np.uint8)
    put_text(card, title, (16, 30), 0.65)
    for i, line in enumerate(lines):
        put_text(card, line, (16, 58 + 19 * i))
    return card


def stacked(pictures: Sequence[Picture]) -> Picture:
    """Pictures below each other, the narrower ones padded with paper."""
    width = max(p.shape[1] for p in pictures)
    padded = [
        np.concatenate([p, np.full((p.shape[0], width - p.shape[1], 3), PAPER, np.uint8)], axis=1) for p in pictures
    ]
    return np.concatenate(padded, axis=0)


def hue(index: int) -> Colour:
    """The index-th of an endless row of colours that differ well (golden-angle hues)."""
    hsv = np.array([[[int(index * 111.246) % 180, 190, 235]]], np.uint8)
    r, g, b = cv2.cvtColor(hsv, cv2.COLOR_HSV2RGB)[0, 0]
    return int(r), int(g), int(b)
