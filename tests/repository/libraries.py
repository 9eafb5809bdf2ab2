#!/usr/bin/env python3
"""Checks that the table in docs/explanation/libraries.md lists the libraries with which the programs are linked:
libraries.py --build BUILD_DIR

With the linker option --as-needed, a program may load fewer libraries than its link command names.
"""

import argparse
import pathlib
import re
import sys

import tree

PAGE = tree.ROOT / "docs/explanation/libraries.md"


def linked(program, ninja):
    """Returns the shared libraries in the link command of a program. The libraries of the C library are left out."""
    build = re.search(rf"^build \S+/{program}: CXX_EXECUTABLE_LINKER.*\n(?:  .*\n)*", ninja, re.MULTILINE)
    line = re.search(r"^  LINK_LIBRARIES = (.*)$", build.group(0), re.MULTILINE).group(1)
    names = set(re.findall(r"/lib([^/\s]+?)\.so\S*", line)) | set(re.findall(r"(?:^|\s)-l(\S+)", line))
    return names - {"pthread", "rt", "m", "dl"}


def stated():
    rows = re.findall(r"^\| `(softgrip[\w-]*)` \| ([^|]*) \|$", PAGE.read_text(), re.MULTILINE)
    return {program: set(re.split(r",\s*", libraries.strip())) for program, libraries in rows}


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--build", type=pathlib.Path, required=True)
    ninja = (parser.parse_args().build / "build.ninja").read_text()
    wrong = [f"{program}: the page says {', '.join(sorted(says))}; the build links {', '.join(sorted(has))}"
             for program, says in stated().items() if says != (has := linked(program, ninja))]
    if len(stated()) < 4:
        wrong.append("the table does not have the 4 programs")
    print("\n".join(wrong) or f"{len(stated())} programs are linked with what {PAGE.name} says")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
