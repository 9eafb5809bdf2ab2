#!/usr/bin/env python3
"""Checks that every file, link and program that the documents name exists, that no page contains a heading twice, and
that headings and table rows are complete: paths.py [--build BUILD_DIR]

The check reads the pages of the top folder and docs/. A word of inline code or of a code block is a path of the
project if its first part is a folder of the project. The programs in build/ are read from the ninja file in BUILD_DIR.
`*` and words in CAPITALS (values that the reader chooses) match any text; `{a,b}` matches a or b.
"""

import argparse
import fnmatch
import itertools
import pathlib
import re
import sys

import tree
from tree import ROOT


def documents():
    return [*sorted(ROOT.glob("*.md")), *sorted((ROOT / "docs").rglob("*.md"))]


def names_and_folders():
    names = tree.names()
    folders = {str(parent) for name in names for parent in pathlib.PurePosixPath(name).parents}
    return set(names) | folders - {"."}


def programs(build):
    """Returns the paths of the files that ninja builds, relative to the build folder, or None without a build."""
    file = build / "build.ninja" if build else None
    if file is None or not file.exists():
        return None
    return set(re.findall(r"^build ([^ :|$]+)", file.read_text(), re.MULTILINE))


def alternatives(word):
    """Expands braces: a{b,c}d gives abd and acd."""
    parts = re.split(r"\{([^{}]*,[^{}]*)\}", word)
    choices = [part.split(",") if index % 2 else [part] for index, part in enumerate(parts)]
    return ["".join(choice) for choice in itertools.product(*choices)]


def pattern_of(word):
    """Returns a regular expression for the word, in which `*` and words in CAPITALS match any text."""
    return re.sub(r"<[^<>]*>|\b[A-Z][A-Z_]+\b(?![.])", "*", word)


def lines_of(text):
    """Yields (line number, line, inside) for every line. `inside` is True if the line is in a code block."""
    inside = False
    for number, line in enumerate(text.splitlines(), 1):
        if line.lstrip().startswith("```"):
            inside = not inside
        else:
            yield number, line, inside


def words_of(text):
    """Yields (line number, word) for each word of inline code and of code blocks."""
    for number, line, inside in lines_of(text):
        for code in [line] if inside else re.findall(r"`([^`]+)`", line):
            for word in re.split(r"[\s'\"=()|;]+", code):
                yield number, word.rstrip(".,:")


def made_by_the_reader(document, text):
    """Returns a function that is true for the files that the reader of a how-to page creates. These are the files of
    the page's code blocks and files whose names contain "example"."""
    if not document.name.startswith("add-"):
        return lambda word: False
    files = set(re.findall(r"^```\w+ file=(\S+)", text, re.MULTILINE))
    return lambda word: word in files or "example" in word


def headings_of(text):
    """Yields (line number, heading) for every heading."""
    for number, line, inside in lines_of(text):
        if not inside and re.match(r"#+ +", line):
            yield number, line.lstrip("#").strip()


def anchors_of(text):
    return {re.sub(r"[^\w\- ]", "", heading.lower()).replace(" ", "-") for _, heading in headings_of(text)}


def links_of(text):
    for number, line in enumerate(text.splitlines(), 1):
        for target in re.findall(r"\]\(([^()\s]+)\)", re.sub(r"`[^`]*`", "", line)):
            if not re.match(r"[a-z]+:", target):
                yield number, target


class Judge:
    def __init__(self, build):
        self.names = names_and_folders()
        self.names |= {name.rsplit(".", 1)[0] for name in self.names if name.endswith((".h", ".cpp"))}
        self.file_names = {name.rsplit("/", 1)[-1] for name in self.names}
        self.roots = {name.split("/")[0] for name in self.names if "/" in name}
        self.programs = programs(build)
        self.findings = []

    def path_exists(self, word):
        word = word.removeprefix("./").rstrip("/")
        if any(symbol in word for symbol in "*?["):
            return any(fnmatch.fnmatchcase(name, word) for name in self.names)
        return word in self.names

    def program_exists(self, word):
        """Returns True if build/PRESET/path/to/program is a program or a folder of programs. Deeper paths in build/
        are files that programs write."""
        parts = word.split("/", 2)
        if len(parts) < 3 or self.programs is None:
            return True
        built = parts[2].rstrip("/")
        return not built or any(fnmatch.fnmatchcase(name, built) or name.startswith(f"{built}/") for name in self.programs)

    def word(self, place, word):
        root = word.removeprefix("./").split("/")[0]
        if re.fullmatch(r"\w+\.(h|cpp|py|sh|cmake)", word) and word not in self.file_names:
            self.findings.append(f"{place}: `{word}`: the project has no such file")
        if "/" not in word or word.startswith(("/", "http")) or not re.fullmatch(r"[\w./*{},<>+\-]+", word):
            return
        for choice in map(pattern_of, alternatives(word)):
            if root in self.roots and not self.path_exists(choice):
                self.findings.append(f"{place}: `{word}`: the project has no such file or folder")
            elif re.match(r"build/(release|debug|demo|asan-ubsan|tsan)/", choice) and not self.program_exists(choice):
                self.findings.append(f"{place}: `{word}`: nothing of that name is built")

    def link(self, document, number, target):
        place = f"{document.relative_to(ROOT)}:{number}"
        path, _, anchor = target.partition("#")
        file = (document.parent / path).resolve() if path else document
        if not file.is_relative_to(ROOT) or str(file.relative_to(ROOT)) not in self.names:
            self.findings.append(f"{place}: no file of the project has the path of the link `{target}`")
        elif anchor and anchor not in anchors_of(file.read_text()):
            self.findings.append(f"{place}: the link `{target}`: that page has no such heading")

    def headings(self, document, text):
        """Checks that no heading is repeated. A link to a repeated heading is ambiguous, and a repeated heading can
        show that the text was pasted twice."""
        seen = {}
        for number, heading in headings_of(text):
            if heading in seen:
                place = f"{document.relative_to(ROOT)}:{number}"
                self.findings.append(f"{place}: the heading `{heading}` is already in line {seen[heading]}")
            seen.setdefault(heading, number)

    def markup(self, document, text):
        """Checks that a space follows the number signs of a heading and that a table row ends with a bar. A formatter
        for another language breaks both."""
        for number, line, inside in lines_of(text):
            place = f"{document.relative_to(ROOT)}:{number}"
            if not inside and re.match(r"#+[^#\s]", line):
                self.findings.append(f"{place}: a heading needs a space after `#`")
            if not inside and line.startswith("|") and not line.rstrip().endswith("|"):
                self.findings.append(f"{place}: a table row must end with `|`")

    def document(self, document):
        text = document.read_text()
        made = made_by_the_reader(document, text)
        self.headings(document, text)
        self.markup(document, text)
        for number, word in words_of(text):
            if not made(word):
                self.word(f"{document.relative_to(ROOT)}:{number}", word)
        for number, target in links_of(text):
            self.link(document, number, target)


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--build", type=pathlib.Path)
    judge = Judge(parser.parse_args().build)
    for document in documents():
        judge.document(document)
    print("\n".join(judge.findings) or f"{len(documents())} documents: all named files, folders and headings exist")
    return 1 if judge.findings else 0


if __name__ == "__main__":
    sys.exit(main())
