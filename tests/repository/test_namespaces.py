#!/usr/bin/env python3
"""The names of every *_test.cpp stand in a namespace of its file's name, so that CI can compile many tests as one file without
two helpers of one name meeting (softgrip_compile_together in cmake/targets.cmake). Names each that does otherwise; exit
code 1 where there is one.
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
            lacking.append(f"{name}: its names stand outside a namespace softgrip::...::{stem}")
    print("\n".join(lacking) or f"{len(tests)} tests")
    return 1 if lacking or not tests else 0


if __name__ == "__main__":
    sys.exit(main())
