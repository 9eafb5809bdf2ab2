#!/usr/bin/env python3
"""Checks that the table in docs/explanation/libraries.md lists the libraries with which the programs are linked, and
that the programs that were built load no other libraries:
libraries.py --build BUILD_DIR

With the linker option --as-needed, a program may load fewer libraries than its link command names. scripts/demo.sh runs
this check for the build of the demo, which uses other compiler options.
"""

import argparse
import pathlib
import re
import subprocess
import sys

import tree

PAGE = tree.ROOT / "docs/explanation/libraries.md"

# The libraries of the compiler: the C library, the C++ runtime and the sanitizers.
RUNTIME = {"c", "m", "gcc_s", "stdc++", "atomic", "asan", "ubsan", "tsan"}


def linked(program, ninja):
    """Returns the shared libraries in the link command of a program, without those of the C library."""
    build = re.search(rf"^build \S+/{program}: CXX_EXECUTABLE_LINKER.*\n(?:  .*\n)*", ninja, re.MULTILINE)
    line = re.search(r"^  LINK_LIBRARIES = (.*)$", build.group(0), re.MULTILINE).group(1)
    names = set(re.findall(r"/lib([^/\s]+?)\.so\S*", line)) | set(re.findall(r"(?:^|\s)-l(\S+)", line))
    return names - {"pthread", "rt", "m", "dl"}


def loaded(program):
    """Returns the shared libraries that a program file needs. The libraries of the compiler are left out."""
    text = subprocess.run(["readelf", "-d", program], capture_output=True, text=True, check=True).stdout
    return set(re.findall(r"\(NEEDED\).*\[lib([^\]]+?)\.so[^\]]*\]", text)) - RUNTIME


def stated():
    rows = re.findall(r"^\| `(softgrip[\w-]*)` \| ([^|]*) \|$", PAGE.read_text(), re.MULTILINE)
    return {program: set(re.split(r",\s*", libraries.strip())) for program, libraries in rows}


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--build", type=pathlib.Path, required=True)
    build = parser.parse_args().build
    ninja, table = (build / "build.ninja").read_text(), stated()
    wrong = [f"{program}: the page says {', '.join(sorted(says))}; the build links {', '.join(sorted(has))}"
             for program, says in table.items() if says != (has := linked(program, ninja))]
    built = {program: build / folder / program for program in table for folder in ("daemon", "tools")
             if (build / folder / program).is_file()}
    wrong += [f"{program} loads {', '.join(sorted(more))}, which the page does not list"
              for program, file in built.items() if (more := loaded(file) - table[program])]
    if len(table) < 4:
        wrong.append("the table does not have the 4 programs")
    if not built:
        wrong.append(f"{build} contains none of the programs {', '.join(table)}")
    print("\n".join(wrong) or f"{PAGE.name} lists the libraries of {len(table)} programs; "
                              f"the {len(built)} built programs load no others")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
