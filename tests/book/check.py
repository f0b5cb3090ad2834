"""Checks a built book: check.py ROOT OUT

Every page of ROOT/docs/src/SUMMARY.md is in OUT/docs/book, with a title and the same headings; every link and picture of every page leads
to a page of the book (and to a place in it), or to a file of ROOT, which is copied to its place in OUT. No page asks a network for how
its examples of Rust could be run.
"""

import re
import shutil
import sys
from html.parser import HTMLParser
from pathlib import Path
from urllib.parse import unquote, urlsplit


class Page(HTMLParser):
    """What a page links to, and the places in it."""

    def __init__(self, path):
        super().__init__()
        self.links, self.ids = [], set()
        self.feed(path.read_text("utf-8"))

    def handle_starttag(self, tag, attributes):
        for key, value in attributes:
            if key in ("href", "src") and value:
                self.links.append(value)
            elif key == "id":
                self.ids.add(value)


def main(root, out):
    book = out / "docs/book"
    listed = re.findall(r"\]\((\w+)\.md\)", (root / "docs/src/SUMMARY.md").read_text("utf-8"))
    pages = {path: Page(path) for path in sorted(book.glob("*.html"))}
    for name in listed:
        assert book / f"{name}.html" in pages, f"{name}.html is missing"
    links = copied = 0
    for path, page in pages.items():
        assert 'class="playground"' not in path.read_text("utf-8"), f"{path.name} asks play.rust-lang.org: see runnable in docs/book.toml"
        for link in page.links:
            parts = urlsplit(link)
            if parts.scheme or link.startswith("//"):
                continue
            # the page for a wrong address of a website has addresses from its top
            target = path if not parts.path else (path.parent / unquote(parts.path).lstrip("/")).resolve()
            assert target.is_relative_to(out), f"{path.name}: {link} leads out of the project"
            if not target.exists():
                source = root / target.relative_to(out)
                assert source.exists(), f"{path.name}: {link} leads nowhere"
                target.parent.mkdir(parents=True, exist_ok=True)
                shutil.copytree(source, target) if source.is_dir() else shutil.copy(source, target)
                copied += 1
            if parts.fragment and target in pages:
                assert unquote(parts.fragment) in pages[target].ids, f"{path.name}: {link} is not a place in that page"
            links += 1
    print(f"book: {len(listed)} pages, {links} links, {copied} files and folders of the project that they lead to")


main(*(Path(argument).resolve() for argument in sys.argv[1:3]))
