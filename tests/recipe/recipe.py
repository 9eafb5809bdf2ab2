"""Executes the steps of a page of docs/how-to on the sources. The sources themselves do not change.

The code blocks of the page are used unchanged. The first line of a block states its use:

    ```cpp file=PATH    creates a new file; also with the names of other languages
    ```diff file=PATH   changes a file. The lines that a diff keeps or removes must occur in the file exactly once.
    ```sh               contains commands, which run after all edits
    ```text expect      contains a message that a test of this page looks for

All other code blocks are ignored.
"""

import os
import pathlib
import re
import resource
import shutil
import subprocess
import sys
import time

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "scripts"))
from source_copy import SOURCE, copy_sources  # noqa: E402

PAGES = [f"docs/how-to/add-a-{part}.md" for part in ("block", "board", "cause", "command")]
FENCE = re.compile(r"^```(\w+) (file=\S+|expect)\n(.*?)^```$|^```(sh)\n(.*?)^```$", re.MULTILINE | re.DOTALL)
# Mounts the edited files over the sources. The mount is visible only to the command, and it ends with the command.
MOUNT = ('mount -t overlay overlay -o "lowerdir=$0,upperdir=$1,workdir=$2,userxattr" "$0" && cd "$0" && shift 2 && '
         'exec "$@"')


class RecipeError(AssertionError):
    """Exception for an edit of the page that does not fit the source."""


def blocks_of(page):
    """Returns (language, use, text) of each code block of the page that has a use."""
    found = FENCE.findall((SOURCE / page).read_text(encoding="utf-8"))
    return [(language or shell, use, text or commands) for language, use, text, shell, commands in found]


def new_file(page, name):
    """Returns the text of a new file of the page."""
    return next(text for language, use, text in blocks_of(page) if language != "diff" and use == f"file={name}")


def changed(name, text, hunk):
    lines = hunk.splitlines()
    old = "".join(line[1:] + "\n" for line in lines if line[:1] != "+")
    new = "".join(line[1:] + "\n" for line in lines if line[:1] != "-")
    if text.count(old) != 1:
        raise RecipeError(f"{name}: found {text.count(old)} times instead of once:\n{old}")
    return text.replace(old, new)


def processor_s():
    """Returns the processor time of all commands so far [s]."""
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


class Tree:
    """The sources with the edits of a page. `folder` gets only the files that the page creates or changes."""

    def __init__(self, folder):
        self.edited = pathlib.Path(folder)
        self.edited.mkdir(parents=True, exist_ok=True)

    def read(self, name):
        path = self.edited / name
        return (path if path.exists() else SOURCE / name).read_text(encoding="utf-8")

    def write(self, name, text):
        path = self.edited / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text, encoding="utf-8")

    def edit(self, page, wanted=lambda name: True):
        """Makes the edits of the page in the files for which `wanted` is true. Returns the names of the files, once for
        each edit."""
        names = []
        for language, use, text in blocks_of(page):
            name = use.removeprefix("file=")
            if name == use or not wanted(name):
                continue
            if language == "diff":
                text = changed(name, self.read(name), text)
            elif (SOURCE / name).exists() or (self.edited / name).exists():
                raise RecipeError(f"{name} exists already")
            self.write(name, text)
            names.append(name)
        return names


class Workplace(Tree):
    """A tree in which commands can run. The edited files are mounted over the sources, so that a command sees the
    existing build in build/release and compiles only what the edits change. If such a mount is not permitted or if
    there is no build, the commands run in a copy of the sources, where they compile everything that they need."""

    def __init__(self, folder):
        super().__init__(pathlib.Path(folder) / "edited")
        work = pathlib.Path(folder) / "work"
        work.mkdir()
        self.root = SOURCE
        self.prefix = ["unshare", "--user", "--map-root-user", "--mount", "sh", "-c", MOUNT, str(SOURCE), str(self.edited),
                       str(work)]
        self.environment = {**os.environ, "CMAKE_BUILD_PARALLEL_LEVEL": str(os.cpu_count())}
        # This change of a file fails if a change below the mount is not permitted, or if there is no build.
        tried = subprocess.run(self.command(["chmod", "u+rw", "build/release/build.ninja"]), capture_output=True, text=True,
                               check=False)
        if tried.returncode != 0:
            print(f"The recipe needs a complete build: {tried.stderr.strip()}")
            self.root, self.prefix = self.edited, []
            if shutil.which("ccache"):
                self.environment.update(CMAKE_CXX_COMPILER_LAUNCHER="ccache", CCACHE_NOHASHDIR="1",
                                        CCACHE_BASEDIR=str(self.root))
            copy_sources(self.root)
            self.run("cmake --preset release -DSOFTGRIP_TESTS=ON -DSOFTGRIP_BENCHMARKS=OFF")

    def command(self, words):
        """Returns a command that runs `words` in the edited sources."""
        return [*self.prefix, *map(str, words)]

    def run(self, line, check=True):
        """Runs a line of shell in the edited sources. Prints the line with its duration and its processor time, and
        returns its output."""
        started, computed = time.monotonic(), processor_s()
        done = subprocess.run(self.command(["bash", "-c", line]), cwd=self.root, env=self.environment, text=True,
                              stdout=subprocess.PIPE, stderr=subprocess.STDOUT, check=False)
        print(f"{time.monotonic() - started:7.1f} s, {processor_s() - computed:7.1f} s of processor time: {line}", flush=True)
        if check != (done.returncode == 0):
            raise AssertionError(f"{line}: exit code {done.returncode}\n{done.stdout[-8000:]}")
        return done.stdout

    def run_commands(self, page):
        """Runs the commands of the page."""
        for language, _, text in blocks_of(page):
            for line in text.splitlines() if language == "sh" else []:
                self.run(line)
