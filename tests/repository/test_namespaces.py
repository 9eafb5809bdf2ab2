#!/usr/bin/env python3
"""Checks that the names of every *_test.cpp are in a namespace with the name of the file. This allows CI to compile
many test files as one file: helper functions of different files do not conflict (softgrip_compile_together in
cmake/targets.cmake). Prints each file that breaks this rule. The exit code is 1 if there is such a file.
"""

import pathlib
import re
import sys

import tree
from tree import ROOT


def main():
    tests = [name for name in tree.names() if name.startswith("tests/") and name.endswith("_test.cpp")]
    lacking = []
    for name in tests:
        stem = pathlib.Path(name).stem
        if not re.search(rf"^namespace softgrip(::\w+)*::{stem} \{{$", (ROOT / name).read_text(), re.MULTILINE):
            lacking.append(f"{name} has no namespace softgrip::...::{stem}")
    print("\n".join(lacking) or f"{len(tests)} tests")
    return 1 if lacking or not tests else 0


if __name__ == "__main__":
    sys.exit(main())
