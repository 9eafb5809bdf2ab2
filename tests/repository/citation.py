"""Checks CITATION.cff. Version and licence must be those of CMakeLists.txt and LICENSE. The file must contain all keys
that the format (cff 1.2.0) requires."""

import re
import sys

import yaml

import tree

REQUIRED = ("cff-version", "message", "title", "authors")


def wrong(text, cmake, licence):
    cff = yaml.safe_load(text)
    found = [f"{key} is missing" for key in REQUIRED if not cff.get(key)]
    if cff.get("cff-version") != "1.2.0":
        found.append(f"cff-version is {cff.get('cff-version')}, not 1.2.0")
    version = re.search(r"project\(softgrip VERSION (\S+)", cmake).group(1)
    if cff.get("version") != version:
        found.append(f"version is {cff.get('version')}, CMakeLists.txt says {version}")
    if cff.get("license") != licence.split()[0]:
        found.append(f"license is {cff.get('license')}, LICENSE begins with {licence.split()[0]}")
    for reference in cff.get("references", []):
        found += [f"a reference has no {key}" for key in ("type", "title", "authors") if key not in reference]
    return found


def main():
    files = [(tree.ROOT / name).read_text() for name in ("CITATION.cff", "CMakeLists.txt", "LICENSE")]
    for sentence in (found := wrong(*files)):
        print(f"CITATION.cff: {sentence}")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
