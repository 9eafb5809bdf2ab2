"""Inserts one defect at a time into the code and checks that a test fails.

    scripts/mutate.py [--per-file N] [--seed S] [--jobs J] [--out FILE] [--again REPORT] [FILE ...]

Without files, it uses the sources of control/, the bus and the loop. A mutant is the code with one defect: an inverted
comparison, sign, logical connective, constant or condition. The seed selects the places of the defects. The script
builds each mutant in a copy of the sources in build/mutants, and runs the tests of its folder until one fails. It
prints the share of detected mutants for each folder, and every mutant that no test has detected (a survivor) with its
line. For a survivor, a test is missing, or the change has no effect. docs/results/mutants-and-branches.md lists the
survivors of both kinds. --again judges only the survivors of an earlier report, with the tests that were added since.
"""

import argparse
import collections
import concurrent.futures
import os
import pathlib
import random
import re
import shutil
import subprocess
import sys
import threading

from source_copy import SOURCE, copy_sources

COPIES = SOURCE / "build/mutants"
TIMEOUT_S = 240
#: Each entry: a folder, the targets to build, and the test commands to run, in this order.
FITTING = (
    ("control/", ("control_test",), (("tests/control_test", "--gtest_fail_fast"),)),
    ("daemon/loop/", ("daemon_test", "softgrip-world"),
     (("tests/daemon_test", "--gtest_fail_fast", "--gtest_filter=*Bus*:*Loop*:*Heartbeat*:*Ring*:*TripleBuffer*:*Histogram*"),
      ("tests/world/softgrip-world", "--count", "150", "--stop"))),
)
#: Additional test commands for a folder. They run the simulated worlds if the unit tests have not detected the defect.
LAST = {"control/tick/": ("softgrip-world", ("tests/world/softgrip-world", "--count", "150", "--stop"))}
OPERATORS = (
    (r"(?<![<>=!-])<(?![<=])(?= )", "<="), (r"(?<=\s)<=(?= )", "<"), (r"(?<=\s)>(?= )", ">="), (r"(?<=\s)>=(?= )", ">"),
    (r"(?<=\s)==(?= )", "!="), (r"(?<=\s)!=(?= )", "=="), (r"(?<=\s)&&(?= )", "||"), (r"(?<=\s)\|\|(?= )", "&&"),
    (r"(?<=[\w)\]] )\+(?= )", "-"), (r"(?<=[\w)\]] )-(?= )", "+"), (r"(?<=[\w)\]] )\*(?= )", "/"),
    (r"\btrue\b", "false"), (r"\bfalse\b", "true"), (r"\bstd::min\b", "std::max"), (r"\bstd::max\b", "std::min"),
    (r"(?<=\bif \()(?=[^;]*\) )", "!("), (r"(?<=[ (])0(?=[;,)])", "1"), (r"(?<=[ (])1(?=[;,)])", "2"),
)


class Mutant:
    def __init__(self, name, line, column, old, new, text):
        self.name, self.line, self.column, self.old, self.new, self.text = name, line, column, old, new, text

    def __str__(self):
        return f"{self.name}:{self.line}: `{self.old.strip()}` -> `{self.new.strip()}`"


def mutants_of(name):
    """Returns every place of a file at which an operator of OPERATORS can insert a defect."""
    lines = (SOURCE / name).read_text().split("\n")
    found, in_comment = [], False
    for number, line in enumerate(lines, 1):
        code = line.split("//")[0]
        in_comment = (in_comment or "/*" in code) and "*/" not in code
        skipped = in_comment or re.match(r"\s*(#|namespace|using|static_assert|template|case |\})", code) or '"' in code
        if skipped:
            continue
        for pattern, replacement in OPERATORS:
            for match in re.finditer(pattern, code):
                new = code[:match.start()] + replacement + code[match.end():]
                if replacement == "!(":  # in an `if (...)` on one line, the defect inverts the whole condition
                    end = closing(code, match.start())
                    if end is None:
                        continue
                    new = code[:match.start()] + "!(" + code[match.start():end] + ")" + code[end:]
                text = "\n".join(lines[:number - 1] + [new] + lines[number:])
                found.append(Mutant(name, number, match.start(), code, new, text))
    return found


def closing(code, begin):
    """Returns the position of the bracket that closes the opening bracket before `begin`."""
    depth = 1
    for at in range(begin, len(code)):
        depth += {"(": 1, ")": -1}.get(code[at], 0)
        if depth == 0:
            return at
    return None


class Copy:
    """A copy of the sources, in which one defect at a time is inserted and built."""

    def __init__(self, number):
        self.root = COPIES / str(number)

    def run(self, arguments, **keys):
        return subprocess.run([str(a) for a in arguments], cwd=self.root, capture_output=True, text=True, **keys)

    def prepare(self, targets):
        shutil.rmtree(self.root, ignore_errors=True)
        copy_sources(self.root)
        done = self.run(["cmake", "--preset", "release", "-DSOFTGRIP_TESTS=ON", "-DSOFTGRIP_WERROR=OFF",
                         "-DCMAKE_CXX_FLAGS_RELWITHDEBINFO=-O1"])
        if done.returncode == 0:
            done = self.run(["cmake", "--build", "build/release", "-j", "1", "--target", *targets])
        if done.returncode:
            sys.exit(done.stdout[-3000:] + done.stderr[-3000:])

    def judge(self, mutant):
        """Inserts a defect, builds and runs the tests. Returns "killed", "survived" or "does not build"."""
        path = self.root / mutant.name
        before = path.read_text()
        path.write_text(mutant.text)
        try:
            return self.verdict(mutant)
        finally:
            path.write_text(before)

    def verdict(self, mutant):
        folder, targets, runs = next(f for f in FITTING if mutant.name.startswith(f[0]))
        last = next((value for key, value in LAST.items() if mutant.name.startswith(key)), None)
        if self.run(["cmake", "--build", "build/release", "-j", "1", "--target", *targets]).returncode:
            return "does not build"
        if any(self.fails(command) for command in runs):
            return "killed"
        if last is None:
            return "survived"
        self.run(["cmake", "--build", "build/release", "-j", "1", "--target", last[0]])
        return "killed" if self.fails(last[1]) else "survived"

    def fails(self, command):
        try:
            return self.run([self.root / "build/release" / command[0], *command[1:]], timeout=TIMEOUT_S).returncode != 0
        except subprocess.TimeoutExpired:
            return True  # a test that does not end has detected the defect


def survivors_of(report):
    """Returns the survivors of an earlier report. Searches their places in the present sources, because the line
    numbers may have changed."""
    listed = re.findall(r"^- (\S+?):\d+: `(.*)` -> `(.*)`$", report.read_text(), re.MULTILINE)
    return [next(m for m in mutants_of(name) if (m.old.strip(), m.new.strip()) == (old, new)) for name, old, new in listed]


def files_by_default():
    listed = subprocess.run(["git", "ls-files", "control/*.cpp", "daemon/loop/bus.cpp", "daemon/loop/loop.cpp"],
                            cwd=SOURCE, capture_output=True, text=True, check=True).stdout.split()
    return sorted(set(listed))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("files", nargs="*")
    parser.add_argument("--per-file", type=int, default=6)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--jobs", type=int, default=os.cpu_count())
    parser.add_argument("--again", type=pathlib.Path, help="report of an earlier run, whose surviving mutants are tested again")
    parser.add_argument("--out", type=pathlib.Path, default=SOURCE / "build/mutants/report.md")
    options = parser.parse_args()

    drawn = survivors_of(options.again) if options.again else []
    for name in [] if options.again else options.files or files_by_default():
        places = mutants_of(name)
        drawn += random.Random(f"{options.seed} {name}").sample(places, min(options.per_file, len(places)))
    targets = sorted({t for mutant in drawn for f in FITTING if mutant.name.startswith(f[0]) for t in f[1]} |
                     {value[0] for key, value in LAST.items() if any(m.name.startswith(key) for m in drawn)})
    copies = [Copy(number) for number in range(options.jobs)]
    with concurrent.futures.ThreadPoolExecutor(options.jobs) as pool:
        list(pool.map(lambda copy: copy.prepare(targets), copies))
    free, lock, done = list(copies), threading.Lock(), []

    def judge(mutant):
        with lock:
            copy = free.pop()
        try:
            verdict = copy.judge(mutant)
        finally:
            with lock:
                free.append(copy)
        with lock:
            done.append((mutant, verdict))
            print(f"{len(done)}/{len(drawn)} {verdict}: {mutant}", flush=True)

    with concurrent.futures.ThreadPoolExecutor(options.jobs) as pool:
        list(pool.map(judge, drawn))
    report(done, options)


def report(done, options):
    score = collections.defaultdict(collections.Counter)
    for mutant, verdict in done:
        score[str(pathlib.Path(mutant.name).parent)][verdict] += 1
    drawn_how = f"survivors of {options.again.name}" if options.again else f"seed {options.seed}, at most {options.per_file} mutants a file"
    lines = [drawn_how, "",
             "| folder | mutants | killed | score |", "|---|---|---|---|"]
    for folder, counts in sorted(score.items()):
        judged = counts["killed"] + counts["survived"]
        lines.append(f"| `{folder}` | {judged} | {counts['killed']} | {100 * counts['killed'] / max(judged, 1):.0f} % |")
    lines += ["", "Survivors:", ""]
    lines += sorted(f"- {mutant}" for mutant, verdict in done if verdict == "survived")
    options.out.parent.mkdir(parents=True, exist_ok=True)
    options.out.write_text("\n".join(lines) + "\n")
    print(options.out.read_text())


if __name__ == "__main__":
    main()
