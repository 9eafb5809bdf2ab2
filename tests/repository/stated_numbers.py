#!/usr/bin/env python3
"""Checks that numbers and names in documents agree with the sources. Checks the stated numbers of threads, fingers and
simulated test cases. The figures of README.md must be on the pages to which README.md links."""

import re
import sys

import tree

WORLD = r"^[a-z_+]+,[0-9.]+,[0-9]+,"
CHANGED_WORLD = r"^[a-z]+,[a-z_]+,[0-9.]+,[0-9]+,"
BLIND = "tests/blind/"


def text(name):
    return (tree.ROOT / name).read_text()


def one_line(name):
    return " ".join(text(name).split())


def sources(folder):
    return [name for name in tree.names() if name.startswith(folder) and name.endswith((".h", ".cpp"))]


def threads():
    """Checks the number of threads that the page states. It must be the number of named threads in the sources of
    softgripd, plus the main thread and the thread that writes the log file."""
    daemon = [text(name) for name in sources("daemon/")]
    made = {name for one in daemon for name in re.findall(r'\.name = "(softgrip-[a-z]+)"', one)}
    pools = sum(one.count("make_shared<spdlog::details::thread_pool>") for one in daemon)
    page = text("docs/explanation/real-time.md")
    rows = re.findall(r"^\| `(softgripd?(?:-[a-z]+)?)`", page, re.MULTILINE)
    if {row for row in rows if row != "softgripd"} != made:
        yield f"real-time.md: the table has {sorted(set(rows))}, the sources name {sorted(made)}"
    if rows.count("softgripd") != 1 + pools:
        yield f"real-time.md: {rows.count('softgripd')} rows `softgripd`, but there are the first thread and {pools} of the log"
    with_lines = len(made) + 1 + pools
    if f"{with_lines - 1} threads, and {with_lines} with digital lines" not in one_line("docs/explanation/real-time.md"):
        yield f"real-time.md does not say {with_lines - 1} threads, and {with_lines} with digital lines"


def fingers():
    most = re.search(r"max_channels = (\d+);", text("control/tick/settings.h")).group(1)
    for page, says in (("README.md", f"drives 1 to {most} fingers"), ("docs/README.md", f"for up to {most} soft fingers")):
        if says not in one_line(page):
            yield f"{page} does not say: {says}"


def worlds():
    """Returns two numbers of rows in the tables of simulated test cases in tests/blind: the rows that every test
    run uses, and the rows that a run with --all uses."""
    counts = {"": 0, "more_": 0}
    for more in counts:
        for folder, name, world in (("", "fixed_worlds", WORLD), ("textbook/", "fixed_worlds", WORLD),
                                    ("", "changed_worlds", CHANGED_WORLD)):
            file = f"{BLIND}{folder}{more}{name.removeprefix('fixed_') if more else name}.csv"
            counts[more] += len(re.findall(world, text(file), re.MULTILINE))
    says = (f"{counts['']} cases with fixed seeds are part of `scripts/test.sh`, and {counts['more_']} "
            "additional cases are part of `scripts/test.sh --all`")
    if says not in one_line("docs/reference/diagnosis-steps.md"):
        yield f"diagnosis-steps.md does not say: {says}"


def front_page():
    """Checks the figures of README.md. Each version hash, count and comparison must be on a page to which the table
    row or sentence of the figure links."""
    body = text("README.md").split("## Four results")[1]
    for part in re.split(r"\n(?=[|-]|\n)", body):
        linked = " ".join(one_line(re.sub(r"#.*", "", link)) for link in re.findall(r"\]\(([^)]+\.md[^)]*)\)", part))
        for figure in re.findall(r"\d[\d,.]* (?:of [\d,]+|times|kPa)|\b[0-9a-f]{8}(?=, `)", part):
            if linked and not re.search(rf"(?<![\d.,]){re.escape(figure)}(?!\d)", linked):
                yield f"README.md: `{figure}` is in no page that its row or sentence links"


def main():
    wrong = [sentence for part in (threads, fingers, worlds, front_page) for sentence in part()]
    print("\n".join(wrong) or "the stated numbers are those of the sources")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
