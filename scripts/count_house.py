#!/usr/bin/env python3
"""Counts the source files, the folders and the includes between folders, in one or several checkouts of this project:

  scripts/count_house.py [--names] [--folders] [CHECKOUT ...]

Prints a table in Markdown with a column for each checkout. --names also prints the files that each count contains.
--folders also prints the lines of each folder. An include counts as an include between folders if the header is in
another folder than the file. Product lines are the lines of .h and .cpp files outside tests/ and bench/.
docs/results/house-counts.md compares three versions.
"""

import argparse
import collections
import pathlib
import re
import subprocess

SMALL, LARGE = 40, 400
DIAGNOSE = "tools/commands/diagnose.cpp"
LIMITS = "sysid/limits/limits.h"
# A named constant of the diagnosis: `constexpr`, a number type, a name, and a value with a digit. Constants that are
# computed from LIMITS, and the folders that only read, write or draw, are not counted.
CONSTANT = (r"constexpr (?:double|float|int|unsigned|long|auto|std::size_t|std::u?int\d+_t|Eigen::Index) (\w+ = [^;{(]*\d[^;]*)(?=;)")
NO_DECISIONS = ("sysid/import", "sysid/logs", "sysid/pages", "sysid/recordings", "sysid/instrument", "sysid/diagnosis/report")
# Folders whose files may contain the id of a block.
AT_HOME = ("model/", "sysid/diagnosis/causes/")


def product(root):
    """Returns {path: text} of the source files of the product."""
    listed = subprocess.run(["git", "-C", root, "ls-files", "--", "*.h", "*.cpp"], check=True, capture_output=True,
                            text=True).stdout.splitlines()
    return {name: (root / name).read_text() for name in listed
            if not name.startswith(("tests/", "bench/")) and (root / name).is_file()}


def folder(name):
    return str(pathlib.PurePosixPath(name).parent)


def included(sources):
    """Returns {path: headers of the project that the file includes}."""
    return {name: [header for header in re.findall(r'^#include "([^"]+)"', text, re.MULTILINE) if header in sources]
            for name, text in sources.items()}


def mutual(arrows):
    """Returns pairs of folders that include each other directly or indirectly."""
    reached = {}
    for start in {one for arrow in arrows for one in arrow}:
        seen, waiting = set(), [start]
        while waiting:
            here = waiting.pop()
            for source, target in arrows:
                if source == here and target not in seen:
                    seen.add(target)
                    waiting.append(target)
        reached[start] = seen
    return sorted((one, other) for one in reached for other in reached[one] if one < other and one in reached[other])


def block_ids(sources):
    found = set()
    for name, text in sources.items():
        if name.startswith("model/blocks/"):
            found |= set(re.findall(r'\.id = "(\w+)"|block_info\(\s*"(\w+)"', text))
    return {one or other for one, other in found}


def block_names(sources):
    """Returns (file, id) for each string literal that contains the id of a block. Omits the files
    that may name a block."""
    ids = block_ids(sources)
    return sorted((name, one) for name, text in sources.items() if not name.startswith(AT_HOME)
                  for one in re.findall(r'"(\w+)"', re.sub(r"//.*", "", text)) if one in ids)


def constants(sources):
    """Returns (file, name) for each named constant of the diagnosis."""
    return [(name, one.split(" = ")[0]) for name, text in sources.items()
            if name.startswith("sysid/") and folder(name) not in NO_DECISIONS
            for several in re.findall(CONSTANT, text) if "limits::" not in several
            for one in several.split(", ") if " = " in one]


def reached_from(start, sources, includes):
    """Returns the sources that a program needs: the included headers, and the source file of each header."""
    seen, waiting = set(), [start]
    while waiting:
        name = waiting.pop()
        if name in seen or name not in sources:
            continue
        seen.add(name)
        stem = name.rsplit(".", 1)[0]
        waiting += includes[name] + [stem + ".cpp", stem + ".h"]
    return seen


def count(root):
    """Returns a list of (measure, count, places that are counted)."""
    sources = product(root)
    lines = {name: text.count("\n") for name, text in sources.items()}
    rooms = collections.Counter(map(folder, sources))
    includes = included(sources)
    crossing = [(folder(name), folder(header)) for name in sources for header in includes[name]
                if folder(name) != folder(header)]
    arrows = set(crossing)
    floors = {(one.split("/")[0], other.split("/")[0]) for one, other in arrows}
    circles = mutual(arrows)
    names = block_names(sources)
    numbers = constants(sources)
    diagnose = reached_from(DIAGNOSE, sources, includes)
    small = sorted(name for name in lines if lines[name] < SMALL)
    large = sorted(name for name in lines if lines[name] > LARGE)
    biggest, files = rooms.most_common(1)[0]
    return [
        ("lines in source files, without tests and benchmarks", sum(lines.values()), []),
        ("lines with only a comment in source files, without tests and benchmarks", sum(len(re.findall(r"^\s*//", text, re.MULTILINE)) for text in sources.values()), []),
        ("source files, without tests and benchmarks", len(sources), []),
        ("folders with sources", len(rooms), []),
        ("number of files in the largest folder", f"{files} (`{biggest}`)", [f"{one}: {n}" for one, n in rooms.most_common(8)]),
        (f"files with fewer than {SMALL} lines", len(small), small),
        (f"files with more than {LARGE} lines", len(large), [f"{one}: {lines[one]}" for one in large]),
        ("include directives that name a file of a different folder", len(crossing), []),
        ("pairs of folders of which the first includes files of the second", len(arrows), []),
        ("pairs of folders that include each other", len(circles), [f"{one} <-> {other}" for one, other in circles]),
        ("pairs of top-level folders that include each other", len(mutual({one for one in floors if one[0] != one[1]})), []),
        ("files that contain the name of a block and do not define this block", len({name for name, _ in names}), [f"{name}: {one}" for name, one in names]),
        ("occurrences of such names in these files", len(names), []),
        (f"limits of decisions in `{LIMITS}`", sum(name == LIMITS for name, _ in numbers), []),
        ("named constants of the diagnosis in other files", sum(name != LIMITS for name, _ in numbers),
         sorted(f"{name}: {one}" for name, one in numbers if name != LIMITS)),
        ("files on which `softgrip diagnose` depends", len(diagnose), []),
        ("folders on which `softgrip diagnose` depends", len(set(map(folder, diagnose))), sorted(set(map(folder, diagnose)))),
    ]


def folder_lines(sources):
    """Returns {folder: lines} for the top-level folders, and for the folders of sysid, tools and daemon."""
    lines = collections.Counter()
    for name, text in sources.items():
        parts = name.split("/")
        deep = parts[0] in ("sysid", "tools", "daemon") and len(parts) > 2
        lines["/".join(parts[:2 if deep else 1])] += text.count("\n")
    return lines


def version(root):
    return subprocess.run(["git", "-C", root, "rev-parse", "--short=8", "HEAD"], check=True, capture_output=True,
                          text=True).stdout.strip()


def print_table(title, versions, rows):
    print(f"| {title} | {' | '.join(versions)} |\n|{'---|' * (len(versions) + 1)}")
    for name, numbers in rows:
        print(f"| {name} | {' | '.join(map(str, numbers))} |")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("checkouts", nargs="*", type=pathlib.Path, metavar="CHECKOUT",
                        default=[pathlib.Path(__file__).resolve().parents[1]])
    parser.add_argument("--names", action="store_true")
    parser.add_argument("--folders", action="store_true")
    args = parser.parse_args()
    versions = [version(root) for root in args.checkouts]
    counted = [count(root) for root in args.checkouts]
    print_table("count", versions, [(rows[0][0], [number for _, number, _ in rows]) for rows in zip(*counted)])
    if args.folders:
        lines = [folder_lines(product(root)) for root in args.checkouts]
        names = sorted(set().union(*lines), key=lambda name: lines[-1][name] - lines[0][name])
        print()
        print_table("lines in folder", versions, [(name, [each[name] for each in lines]) for name in names])
    if args.names:
        for name, counts in zip(versions, counted):
            for what, _, places in counts:
                if places:
                    print(f"\n{name}, {what}:", *places, sep="\n  ")


if __name__ == "__main__":
    main()
