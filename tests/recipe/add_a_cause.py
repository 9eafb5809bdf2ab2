#!/usr/bin/python3
"""Executes the steps of docs/how-to/add-a-cause.md in a copy of the source tree. Uses the files, edits and commands
of the page.

    add_a_cause.py --source DIR --work DIR

The first line of a code block selects what the program does with the block. ```cpp file=PATH: writes the block to a
new file. ```diff file=PATH: adds lines between existing lines. ```sh: runs the block. ```text expect: requires the
text in the output of a build without the last registration."""
import argparse
import os
import pathlib
import re
import shutil
import subprocess
import sys

PAGE = "docs/how-to/add-a-cause.md"
REGISTRY = "sysid/diagnosis/causes/registry.h"
FENCE = re.compile(r"^```(\w+)(?: ([^\n]*))?\n(.*?)^```$", re.MULTILINE | re.DOTALL)


def copy_of(source, target):
    """Copies the files that git tracks and the new files that git does not ignore. If the source is not a git
    repository, copies all files except the builds."""
    if target.exists():
        kept = target / "build"
        for path in target.iterdir():
            if path != kept:
                shutil.rmtree(path) if path.is_dir() else path.unlink()
    listed = subprocess.run(["git", "ls-files", "-z", "-co", "--exclude-standard"], cwd=source, capture_output=True)
    if listed.returncode != 0:
        shutil.copytree(source, target, dirs_exist_ok=True, ignore=shutil.ignore_patterns("build", ".git"))
        return
    for name in listed.stdout.decode().split("\0"):
        if not name or not (source / name).is_file():
            continue
        (target / name).parent.mkdir(parents=True, exist_ok=True)
        shutil.copy2(source / name, target / name)


def insert(path, hunk):
    """Adds the lines marked + of a hunk to a file. The other lines of the hunk must occur in the file exactly once.
    Ignores differences in spacing."""
    parts = [(line[0], line[1:]) for line in hunk.splitlines()]
    assert all(mark in " +" for mark, _ in parts), f"{path}: a hunk only adds"
    wanted = [line.split() for mark, line in parts if mark == " "]
    lines = path.read_text().splitlines()
    found = [i for i in range(len(lines)) if [line.split() for line in lines[i:i + len(wanted)]] == wanted]
    assert len(found) == 1, f"{path}: the lines of a hunk stand in it {len(found)} times:\n{hunk}"
    kept = iter(lines[found[0]:found[0] + len(wanted)])
    lines[found[0]:found[0] + len(wanted)] = [next(kept) if mark == " " else line for mark, line in parts]
    path.write_text("\n".join(lines) + "\n")


def run(command, folder, check=True):
    print("$", command, flush=True)
    done = subprocess.run(command, shell=True, cwd=folder, text=True, stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
    print("\n".join(done.stdout.splitlines()[-40:]), flush=True)
    assert not check or done.returncode == 0, f"exit code {done.returncode}"
    return done


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--source", type=pathlib.Path, required=True)
    parser.add_argument("--work", type=pathlib.Path, required=True)
    args = parser.parse_args()
    copy = args.work / "source"
    copy_of(args.source, copy)
    if shutil.which("ccache"):  # ccache reuses the objects of unchanged files from the existing build
        os.environ.update(CMAKE_CXX_COMPILER_LAUNCHER="ccache", CCACHE_NOHASHDIR="1",
                          CCACHE_BASEDIR=os.path.commonpath([args.source, copy]))
    run("cmake --preset release -DSOFTGRIP_TESTS=ON -DSOFTGRIP_BENCHMARKS=OFF", copy)
    commands, expected, registered = [], [], ""
    for language, words, body in FENCE.findall((args.source / PAGE).read_text()):
        file = re.fullmatch(r"file=(\S+)", words or "")
        if language == "sh":
            commands += body.splitlines()
        elif words == "expect":
            expected.append(body.strip())
        elif language == "diff" and file[1] == REGISTRY:
            registered += body + "\0"
        elif language == "diff":
            insert(copy / file[1], body)
        elif file:
            (copy / file[1]).write_text(body)
    # If no cause uses a block, the source must not compile. The compiler must print the error message that the page
    # quotes.
    refused = run("cmake --build build/release --target softgrip_sysid_diagnosis_causes", copy, check=False)
    assert refused.returncode != 0 and expected, "a block without a cause compiles"
    for sentence in expected:
        assert sentence in refused.stdout, f"the build does not say: {sentence}"
    for hunk in filter(None, registered.split("\0")):
        insert(copy / REGISTRY, hunk)
    for command in commands:
        run(command, copy)


if __name__ == "__main__":
    try:
        main()
    except AssertionError as wrong:
        sys.exit(f"add_a_cause: {wrong}")
