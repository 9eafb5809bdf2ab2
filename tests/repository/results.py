#!/usr/bin/env python3
"""Checks each page of docs/results. The page must begin with the meaning of the result. A table of version,
date, command and conditions must follow. Also checks that docs/README.md or docs/results/README.md has a link to each
page of docs/."""

import re
import sys

import paths
import tree

RESULTS = tree.ROOT / "docs/results"
HEAD = "| version | date | command | conditions |"


def findings_of(name, text):
    blocks = text.split("\n\n")
    table = blocks[2].splitlines() if len(blocks) > 2 else []
    if table[:1] != [HEAD]:
        yield f"{name}: after the heading, one paragraph states the meaning of the result, then comes the table `{HEAD}`"
        return
    if not re.match(r"[A-Z0-9`]", blocks[1]) or re.match(r"(Written|This page was written) by", blocks[1]):
        yield f"{name}: the first sentence does not state the meaning of the result"
    for row in table[2:]:
        cells = [cell.strip() for cell in row.strip("|").split(" | ")]
        if len(cells) != 4 or not all(cells):
            yield f"{name}: a cell of the table of versions is empty: {row}"
        elif not re.search(r"softgrip \d+\.\d+\.\d+", cells[0]) or not re.fullmatch(r"\d{4}-\d\d-\d\d", cells[1]):
            yield f"{name}: not a version and a date (softgrip 0.2.0+COMMIT, YYYY-MM-DD): {row}"


def unlinked():
    indices = [tree.ROOT / "docs/README.md", RESULTS / "README.md"]
    linked = {(index.parent / target.partition("#")[0]).resolve() for index in indices
              for _, target in paths.links_of(index.read_text())}
    for page in sorted((tree.ROOT / "docs").rglob("*.md")):
        if page not in linked and page != indices[0]:
            yield f"{page.relative_to(tree.ROOT)}: linked neither from docs/README.md nor from docs/results/README.md"


def main():
    pages = [page for page in sorted(RESULTS.glob("*.md")) if page.name != "README.md"]
    wrong = [one for page in pages for one in findings_of(page.relative_to(tree.ROOT), page.read_text())] + list(unlinked())
    print("\n".join(wrong) or f"{len(pages)} pages of results state version, date, command and conditions")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
