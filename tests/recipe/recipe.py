"""Executes the steps of a page of docs/how-to in a copy of the source tree, and builds the copy.

The code blocks of the page are used unchanged. A block ```cpp file=PATH creates a new file. A block ```diff file=PATH
changes a file. The lines that a diff keeps or removes must occur in the file exactly once.
"""

import os
import pathlib
import re
import shutil
import subprocess
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "scripts"))
from source_copy import SOURCE, copy_sources  # noqa: E402


class RecipeError(AssertionError):
    """Exception for an edit of the page that does not fit the source."""


FENCE = re.compile(r"^```(\w+) file=(\S+)\n(.*?)^```$", re.MULTILINE | re.DOTALL)


def change(path, hunk):
    lines = hunk.splitlines()
    old = "".join(line[1:] + "\n" for line in lines if line[:1] != "+")
    new = "".join(line[1:] + "\n" for line in lines if line[:1] != "-")
    text = path.read_text(encoding="utf-8")
    if text.count(old) != 1:
        raise RecipeError(f"{path}: found {text.count(old)} times instead of once:\n{old}")
    path.write_text(text.replace(old, new), encoding="utf-8")


class Tree:
    """A copy of the source tree in `folder`. The copy has its own build."""

    def __init__(self, folder):
        self.folder = pathlib.Path(folder) / "softgrip"
        self.build = self.folder / "build" / "release"
        copy_sources(self.folder)

    def carry_out(self, page):
        """Applies the code blocks of the page to the copy and returns the number of blocks."""
        fences = FENCE.findall((SOURCE / page).read_text(encoding="utf-8"))
        for language, name, body in fences:
            path = self.folder / name
            if language == "diff":
                change(path, body)
            elif path.exists():
                raise RecipeError(f"{path} exists already")
            else:
                path.parent.mkdir(parents=True, exist_ok=True)
                path.write_text(body, encoding="utf-8")
        return len(fences)

    def make(self, *targets):
        """Builds the targets with the release preset. Uses ccache if it is installed."""
        launcher = shutil.which("ccache")
        options = [f"-DCMAKE_CXX_COMPILER_LAUNCHER={launcher}"] if launcher else []
        environment = {**os.environ, "CCACHE_BASEDIR": str(self.folder)}
        self.run(["cmake", "--preset", "release", "-DSOFTGRIP_TESTS=ON", *options], env=environment)
        self.run(["cmake", "--build", "build/release", "-j", str(os.cpu_count()), "--target", *targets],
                 env=environment)

    def run(self, command, **more):
        done = subprocess.run(command, cwd=self.folder, capture_output=True, text=True, check=False, **more)
        if done.returncode != 0:
            raise AssertionError(f"{command}: {done.returncode}\n{done.stdout[-4000:]}\n{done.stderr[-4000:]}")
        return done.stdout
