"""Finds two types with the same name in the same namespace, in headers that do not include each other. A program with
two such types compiles and links, but it crashes, because the linker uses one destructor for both types. Prints each
pair of types. The exit code is 1 if a pair exists.

    one_definition.py
"""
import pathlib
import re
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
# A build includes only one of these two headers, so both headers may define the same types.
ALTERNATIVES = {"drivers/gpio/libgpiod_1.h", "drivers/gpio/libgpiod_2.h"}
DECLARED = re.compile(r"^(?:struct|class|enum class) (?:\[\[\w+\]\] )?(\w+)(?: final)?(?: :.*)? \{", re.M)


def types_of(text):
    """Returns (namespace, name) of every type whose declaration starts at the beginning of a line. The namespace is
    the one that the file has opened last before the declaration."""
    for found in DECLARED.finditer(text):
        opened = re.findall(r"^namespace ([\w:]+) \{", text[:found.start()], re.M)
        yield (opened[-1] if opened else "", found[1])


def main():
    listed = subprocess.run(["git", "ls-files", "*.h"], cwd=ROOT, capture_output=True, text=True, check=True)
    homes = {}
    for name in listed.stdout.split():
        if not name.startswith(("tests/", "bench/")) and name not in ALTERNATIVES:
            for key in types_of((ROOT / name).read_text()):
                homes.setdefault(key, set()).add(name)
    twice = {key: files for key, files in homes.items() if len(files) > 1}
    for (namespace, name), files in sorted(twice.items()):
        print(f"{namespace}::{name} is defined in {' and in '.join(sorted(files))}")
    if not homes:
        print("no headers were found")
    return 1 if twice or not homes else 0


if __name__ == "__main__":
    sys.exit(main())
