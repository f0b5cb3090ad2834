"""The examples of the package in the README and in the book, run as they stand there, those of a page one after the other."""

import math
import os
import re
from pathlib import Path
from typing import Any

import pytest

ROOT = Path(os.environ["SPINNEB_CONFIGS"]).parent if "SPINNEB_CONFIGS" in os.environ else Path(__file__).parents[2]


def examples(page: Path) -> list[str]:
    """But for the one without the package, which is run with the programs of others."""
    blocks = re.findall(r"```python\n(.*?)```", page.read_text("utf-8"), flags=re.S)
    return [block for block in blocks if "path.npz" not in block]


def test_the_example_of_the_readme_runs_and_its_lifetimes_are_numbers() -> None:
    [example] = examples(ROOT / "README.md")
    names: dict[str, Any] = {}
    *lines, last = example.strip().splitlines()
    exec("\n".join(lines), names)
    assert names["result"].certified
    lifetimes = eval(last, names)
    assert len(lifetimes) > 0 and all(t > 0.0 and math.isfinite(t) for t in lifetimes), lifetimes


PAGES = [page for page in sorted((ROOT / "docs/src").glob("*.md")) if examples(page)]


def test_there_are_examples_in_the_book() -> None:
    assert {page.stem for page in PAGES} >= {"own_term", "python"}


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.stem)
def test_the_examples_of_a_page_run(page: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    names: dict[str, Any] = {}
    for example in examples(page):
        exec(example, names)
    assert names["result"].certified
