#!/usr/bin/env python3
"""Checks that the programs open files in base/files.cpp and write files in base/file_writing.cpp.

The C++ code of the programs may contain other calls that open, create or rename a file. Each of these calls must be
listed in file_calls.txt with its reason:

    PATH: COUNT CALL: REASON

The list may only become shorter. If a call is removed from the code, its entry must be deleted. Calls that open a
folder are not counted.
"""

import pathlib
import re
import sys

import tree
from tree import ROOT

LIST = pathlib.Path(__file__).with_name("file_calls.txt")
THE_PLACES = ("base/files.cpp", "base/file_writing.cpp")
# Maps the name of a call in the list to a regular expression. The name open without :: stands for the system call,
# which has a flag such as O_RDONLY as an argument.
CALLS = {
    "fstream": r"\bstd::(?:basic_)?[io]?f(?:stream|ilebuf)\b",
    "fopen": r"\b(?:fopen|fopen64|freopen|fdopen|tmpfile)\s*\(",
    "open": r"(?:(?<![\w>])::open(?:at2?|64)?\s*\(|(?<![\w.>:])open(?:at2?|64)?\s*\((?=[^;]*\bO_[A-Z]+\b))(?![^;]*\bO_DIRECTORY\b)",
    "mkstemp": r"\b(?:mkstemp|mkostemp|mkstemps|creat|memfd_create)\s*\(",
    "rename": r"(?:\bstd::|(?<![\w>])::|\bfs::|\bfilesystem::)rename(?:at2?)?\s*\(",
    "copy": r"\b(?:copy_file|copy_options|(?:fs|filesystem)::copy)\b",
    "resize": r"\b(?:resize_file|(?:::)?f?truncate(?:64)?)\s*\(",
    "link": r"\b(?:(?:::)?(?:link|symlink|linkat|symlinkat)|create_(?:hard_link|symlink))\s*\(",
    "matio": r"\bMat_(?:Open|Create\w*)\s*\(",
    "hdf5": r"\bH5F(?:open|create)\s*\(",
    "log file": r"\b(?:basic|rotating|daily)_file_sink|\b(?:basic|rotating|daily)_logger_mt\b",
    "zlib file": r"\bgzopen\b",
    "cairo file": r"\bcairo_\w+_surface_create(?:_from_png)?\s*\((?=\s*[\"\w]*(?:path|file|name))",
}
COMMENT_OR_STRING = re.compile(r'//[^\n]*|/\*.*?\*/|"(?:\\.|[^"\\\n])*"', re.S)


def without_comments_and_strings(text):
    return COMMENT_OR_STRING.sub(lambda found: '""' if found[0].startswith('"') else re.sub(r"[^\n]", " ", found[0]), text)


def calls_in(text):
    """Returns (name of the call, line) for every call in a file."""
    plain = without_comments_and_strings(text)
    for name, pattern in CALLS.items():
        for found in re.finditer(pattern, plain):
            yield name, plain[:found.start()].count("\n") + 1


def excused():
    """Returns {(path, call): number of listed calls}."""
    allowed = {}
    for line in LIST.read_text().splitlines():
        if line and not line.startswith("#"):
            path, count_and_call, reason = line.split(": ", 2)
            count, call = count_and_call.split(" ", 1)
            assert call in CALLS and reason.strip(), line
            allowed[path, call] = int(count)
    return allowed


def findings_in(sources, allowed):
    lines = {}
    for name, text in sources:
        for call, line in calls_in(text):
            lines.setdefault((name, call), []).append(line)
    for (name, call), at in sorted(lines.items()):
        if name not in THE_PLACES and len(at) > allowed.get((name, call), 0):
            yield f"{name}:{at[-1]}: {call}: use base/files.h, or name the reason in {LIST.name}"
    for (name, call), count in sorted(allowed.items()):
        if len(lines.get((name, call), [])) < count:
            yield f"{LIST.name}: {name} has fewer calls: {call}"


def check_itself():
    """Checks that the regular expressions find every type of call in code, and find no call in a comment or a
    string."""
    examples = {"fstream": "std::ofstream file(path);", "fopen": "std::fopen(path, mode);",
                "open": "int file = open(path.c_str(),\n  O_WRONLY | O_CREAT);", "mkstemp": "::mkstemp(name);",
                "rename": "fs::rename(from, to, error);", "copy": "fs::copy_file(from, to);", "resize": "ftruncate(file, 0);",
                "link": "::link(from, to);", "matio": "Mat_CreateVer(path, nullptr, version);",
                "hdf5": "H5Fopen(path, flags, list);", "log file": "spdlog::sinks::basic_file_sink_mt sink(path);",
                "zlib file": "gzopen(path, mode);", "cairo file": "cairo_pdf_surface_create(path, 1, 1);"}
    for name, example in examples.items():
        assert [call for call, _ in calls_in(example)] == [name], name
        for hidden in (f"// {example}".replace("\n", "\n//"), f"/* {example} */", 'say("' + example.replace("\n", " ") + '");'):
            assert not list(calls_in(hidden)), hidden
        assert list(findings_in([("tools/new.cpp", example)], {}))
        assert list(findings_in([("tools/new.cpp", example + "\n" + example)], {("tools/new.cpp", name): 1}))
    assert set(examples) == set(CALLS)
    assert list(calls_in("Descriptor file(::openat(folder, name, flags | always, 0600));"))
    assert not list(calls_in("Gate::open(token); board.open(deadline); ::open(folder, O_RDONLY | O_DIRECTORY);"))
    assert list(findings_in([], {("tools/gone.cpp", "open"): 1}))


def main():
    check_itself()
    names = [name for name in tree.names() if name.endswith((".h", ".cpp")) and not name.startswith(("tests/", "bench/", "examples/"))]
    findings = list(findings_in([(name, (ROOT / name).read_text()) for name in names], excused()))
    print("\n".join(findings) or f"{len(names)} sources read and write files through base/files.h")
    return 1 if findings or len(names) < 100 else 0


if __name__ == "__main__":
    sys.exit(main())
