#!/usr/bin/env python3
"""Checks the sources with clang-tidy (.clang-tidy gives the checks and the reasons for the omitted ones):

  scripts/tidy.py                    all of them
  scripts/tidy.py daemon tools/rig   these folders or files

build/tidy remembers the result of a clean source until the source, a header of the project that it includes, its
compiler command, .clang-tidy or the version of clang-tidy changes. If the build compiles the files of a folder as one
file and many of them must be checked, clang-tidy also checks them as one file, in a tenth of the time. The compiler
then checks one by one that each file includes the headers that it needs. The environment may set JOBS and BUILD_DIR
(default: all cores, build/release). The exit code is 1 if there are findings.
"""

import concurrent.futures
import hashlib
import json
import os
import pathlib
import re
import shlex
import subprocess
import sys
import time

ROOT = pathlib.Path(__file__).resolve().parents[1]
BUILD = ROOT / os.environ.get("BUILD_DIR", "build/release")
CACHE = ROOT / "build/tidy"
FEW = 3
# clang-tidy checks that are switched off for tests. A test may copy objects, and it may use a floating-point loop
# counter.
OFF_IN_TESTS = "-performance-*", "-clang-analyzer-security.FloatLoopCounter"


def sources(places):
    listed = subprocess.run(["git", "ls-files", "--", *places], cwd=ROOT, capture_output=True, text=True, check=True)
    return [name for name in listed.stdout.splitlines() if name.endswith(".cpp")]


def commands():
    """Returns the compiler arguments of each source. Removes precompiled headers, and warnings and parameters of GCC
    that clang does not know."""
    if not (BUILD / "compile_commands.json").exists():
        subprocess.run(["cmake", "--preset", "release", "-B", BUILD], cwd=ROOT, check=True, stdout=subprocess.DEVNULL)
    found = {}
    for entry in json.loads((BUILD / "compile_commands.json").read_text()):
        words = shlex.split(entry["command"])
        while words and not words[0].endswith("++"):
            words.pop(0)  # removes a compiler launcher, such as ccache
        kept = [word for i, word in enumerate(words)
                if word != "-Winvalid-pch" and not word.startswith("--param=") and not word.endswith("cmake_pch.hxx")
                and not (word == "-include" and words[i + 1].endswith("cmake_pch.hxx"))]
        found[os.path.relpath(entry["file"], ROOT)] = {**entry, "command": shlex.join([*kept, "-Wno-unknown-warning-option"])}
    rooms = {name: files_of(name) for name in found if "/Unity/" in name}
    for room, files in rooms.items():
        for name in files:
            found[name] = alike(found[room], name)
    # Some sources, such as fuzz targets, are not compiled by this build. Such a source gets the compiler arguments of
    # another source in the same folder.
    for name in sources(["."]):
        if name not in found and not other_library(name, found):
            near = max(found, key=lambda other: len(os.path.commonprefix([name, other])))
            found[name] = alike(found[near], name)
    return found, rooms


def other_library(name, found):
    """Returns True if the file is for a version of a library that is not installed. In this case, the build uses the
    file for the installed version."""
    twin = re.sub(r"_([12])\.cpp$", lambda match: f"_{3 - int(match[1])}.cpp", name)
    return name not in found and twin != name and twin in found


def files_of(room):
    """Returns the files that a unity source of CMake includes, that is, a source that compiles several files as
    one."""
    included = re.findall(r'^#include "([^"]+)"', (ROOT / room).read_text(), re.MULTILINE)
    return [os.path.relpath(name, ROOT) for name in included]


def alike(entry, name):
    return {**entry, "file": str(ROOT / name), "command": entry["command"].replace(entry["file"], str(ROOT / name))}


class Keys:
    """Returns a checksum of all files and settings on which the result for a source depends."""

    def __init__(self, found):
        self.commands = found
        self.files = {}
        version = subprocess.run(["clang-tidy", "--version"], capture_output=True, text=True, check=True).stdout
        self.common = version + (ROOT / ".clang-tidy").read_text() + " ".join(OFF_IN_TESTS)

    def file(self, name):
        """Returns (checksum, headers of the project that the source includes)."""
        if name not in self.files:
            text = (ROOT / name).read_bytes()
            beside = os.path.dirname(name)
            headers = set()
            for header in re.findall(rb'^#include "([^"]+)"', text, re.MULTILINE):
                near = os.path.normpath(os.path.join(beside, header.decode()))
                headers |= {path for path in (near, header.decode()) if (ROOT / path).is_file()}
            self.files[name] = hashlib.sha256(text).hexdigest(), headers
        return self.files[name]

    def of(self, source):
        seen, waiting = set(), [source]
        while waiting:
            name = waiting.pop()
            if name not in seen:
                seen.add(name)
                waiting += self.file(name)[1]
        parts = [self.common, self.commands[source]["command"].replace(str(ROOT), ""), *(name + self.file(name)[0] for name in sorted(seen))]
        return hashlib.sha256("\n".join(parts).encode()).hexdigest()


def run_clang_tidy(source, in_tests, *off):
    off += OFF_IN_TESTS if in_tests else ()
    # The configuration file is named explicitly, because clang-tidy would not find it for a source outside the project
    # folder.
    options = [f"--config-file={ROOT / '.clang-tidy'}", *([f"--checks={','.join(off)}"] if off else [])]
    run = subprocess.run(["clang-tidy", "-p", CACHE, "--quiet", *options, source], cwd=ROOT, capture_output=True, text=True)
    return run.returncode == 0, run.stdout + ("" if run.returncode == 0 else run.stderr)


def compile_alone(entry):
    run = subprocess.run([*shlex.split(entry["command"]), "-fsyntax-only"], cwd=entry["directory"], capture_output=True, text=True)
    return run.returncode == 0, run.stderr


def is_of_tests(name):
    return name.startswith("tests/")


def looks(due, found, rooms):
    """Returns (sources, records), beginning with the longest source. A record states that a source is clean."""
    together, alone = [], set(due)
    for room, files in rooms.items():
        of_room = [name for name in files if name in alone]
        if len(of_room) > FEW:
            alone -= set(of_room)
            in_tests = is_of_tests(of_room[0])
            together.append((of_room, [lambda room=room, in_tests=in_tests: run_clang_tidy(room, in_tests, "-bugprone-suspicious-include"),
                                       *(lambda entry=found[name]: compile_alone(entry) for name in of_room)]))
    together.sort(key=lambda one: -len(one[0]))
    return together + [([name], [lambda name=name: run_clang_tidy(name, is_of_tests(name))]) for name in sorted(alone)]


def look(shown_by):
    answers = [show() for show in shown_by]
    return all(clean for clean, _ in answers), "\n".join(text for clean, text in answers if not clean)


def main():
    wanted = sources(sys.argv[1:] or ["."])
    if not wanted:
        print("tidy.py: the given paths contain no sources", file=sys.stderr)
        return 2
    found, rooms = commands()
    wanted = [name for name in wanted if not other_library(name, found)]
    CACHE.mkdir(parents=True, exist_ok=True)
    (CACHE / "compile_commands.json").write_text(json.dumps(list(found.values())))
    keys = Keys(found)
    due = {source: CACHE / keys.of(source) for source in wanted}
    due = {source: mark for source, mark in due.items() if not mark.exists()}
    print(f"{len(wanted)} sources, {len(due)} of them to be checked", flush=True)

    started, failed, told = time.monotonic(), 0, set()
    with concurrent.futures.ThreadPoolExecutor(int(os.environ.get("JOBS", os.cpu_count()))) as pool:
        waiting = {pool.submit(look, shown_by): names for names, shown_by in looks(due, found, rooms)}
        for future in concurrent.futures.as_completed(waiting):
            clean, text = future.result()
            names = waiting[future]
            if clean:
                for name in names:
                    due[name].touch()
                continue
            failed += 1
            # A finding in a header occurs once for each source that includes the header. Report each of these findings
            # once.
            findings = re.split(r"\n(?=\S+:\d+:\d+: (?:error|warning): )", "\n" + text)
            print("\n".join(one for one in findings if one not in told).strip() or names[0], flush=True)
            told |= set(findings)
    print(f"{failed} of {len(waiting)} checks with findings, {time.monotonic() - started:.0f} s")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
