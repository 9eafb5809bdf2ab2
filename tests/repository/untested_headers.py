#!/usr/bin/env python3
"""Checks that tests include every header, directly or through another header. If no test includes a header,
untested_headers.txt must list this header with a reason. The list may only become shorter. If a test includes a listed
header, or if a listed header is deleted, its entry must be removed."""

import pathlib
import re
import sys

import tree
from tree import ROOT

LIST = pathlib.Path(__file__).with_name("untested_headers.txt")


def reached(names):
    included = {name: re.findall(r'^#include "([^"]+)"', (ROOT / name).read_text(), re.MULTILINE) for name in names}
    seen, waiting = set(), [name for name in names if name.startswith("tests/")]
    while waiting:
        name = waiting.pop()
        if name not in seen:
            seen.add(name)
            waiting += [header for header in included[name] if header in included]
    return seen


def main():
    names = [name for name in tree.names() if name.endswith((".h", ".cpp"))]
    headers = {name for name in names if name.endswith(".h") and not name.startswith(("tests/", "bench/"))}
    tested = reached(names)
    listed = {line for line in LIST.read_text().split("\n") if line and not line.startswith("#")}

    findings = [f"{name}: no test includes this header directly or through another header"
                for name in sorted(headers - tested - listed)]
    findings += [f"{name}: is in {LIST.name}, but a test includes it" for name in sorted(listed & tested)]
    findings += [f"{name}: is in {LIST.name}, but there is no such header" for name in sorted(listed - headers)]
    print("\n".join(findings) or f"tests reach {len(headers) - len(listed)} of {len(headers)} headers")
    return 1 if findings else 0


if __name__ == "__main__":
    sys.exit(main())
