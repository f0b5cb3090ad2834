"""What cells of a notebook show."""

from __future__ import annotations

import html
from collections.abc import Iterable, Sequence

__all__ = ["drawing", "paragraph", "table"]


def paragraph(words: str) -> str:
    """A line of text."""
    return f"<p>{html.escape(words)}</p>"


def table(rows: Iterable[Sequence[str]], head: Sequence[str] = ()) -> str:
    """Rows of cells, to the left, below a head."""
    top = "".join(f'<th style="text-align: left">{html.escape(cell)}</th>' for cell in head)
    body = ("".join(f'<td style="text-align: left">{html.escape(cell)}</td>' for cell in row) for row in rows)
    return f"<table>{f'<thead><tr>{top}</tr></thead>' if head else ''}<tbody>{''.join(f'<tr>{row}</tr>' for row in body)}</tbody></table>"


def drawing(svg: bytes) -> str:
    """A figure without the head of its file; nothing for none."""
    text = svg.decode()
    return text[text.find("<svg") :] if "<svg" in text else ""
