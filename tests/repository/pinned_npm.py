"""Checks that npm packages are pinned. The lock file must contain the exact version and a hash of each package. The
lock file must not contain the address of a registry, so that npm uses the registry in the configuration of the
machine."""

import json
import pathlib
import re
import sys

import tree


def wrong(package, lock):
    found = [f"{name}: {version} is not one exact version"
             for name, version in package.get("dependencies", {}).items() if not re.fullmatch(r"\d+\.\d+\.\d+", version)]
    if lock["packages"][""].get("dependencies") != package.get("dependencies"):
        found.append("the dependencies in the lock file differ from those in package.json")
    for path, locked in lock["packages"].items():
        if path and "integrity" not in locked:
            found.append(f"{path} has no hash")
        if "resolved" in locked:
            found.append(f"{path} has an address (npm --omit-lockfile-registry-resolved)")
    return found


def main():
    failed = False
    for name in tree.names():
        if pathlib.PurePosixPath(name).name == "package.json":
            folder = (tree.ROOT / name).parent
            for sentence in wrong(*(json.loads((folder / file).read_text()) for file in ("package.json", "package-lock.json"))):
                print(f"{name}: {sentence}")
                failed = True
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
