#!/usr/bin/python3
"""Checks that the edits of the how-to pages fit the sources, and that the new files and the edited headers compile. Does
not build the edited sources: `ctest -L recipe` does."""

import concurrent.futures
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path[:0] = [str(ROOT / "tests" / "recipe")]

import recipe  # noqa: E402


def compiled(tree, names):
    """Returns the error messages of the compiler for edited files; empty if they compile or if no compiler is installed.
    The compiler reads all files of a page as one file, because most of its time is for the headers of the libraries."""
    compiler = next(filter(None, map(shutil.which, ("c++", "g++", "clang++"))), None)
    if compiler is None:
        return ""
    included = [word for name in names for word in ("-include", tree.edited / name)]
    done = subprocess.run([compiler, "-std=c++20", "-Wall", "-Wextra", "-fsyntax-only", "-I", tree.edited, "-I", ROOT,
                           *included, "-x", "c++", "/dev/null"], capture_output=True, text=True, check=False)
    return done.stderr


def main():
    with tempfile.TemporaryDirectory(prefix="softgrip-recipes-") as folder, \
            concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as threads:
        checks, edits, files = {}, 0, 0
        for page in recipe.PAGES:
            tree = recipe.Tree(pathlib.Path(folder) / pathlib.Path(page).stem)
            try:
                names = tree.edit(page)
            except recipe.RecipeError as error:
                sys.exit(f"{page}: {error}")
            edits += len(names)
            compilable = [name for name in dict.fromkeys(names)
                          if name.endswith(".h") or (name.endswith(".cpp") and not (ROOT / name).exists())]
            # Headers come first, so that no source provides an include that a header lacks.
            compilable.sort(key=lambda name: not name.endswith(".h"))
            files += len(compilable)
            if compilable:
                checks[page] = threads.submit(compiled, tree, compilable)
        wrong = [f"{page}\n{check.result()}" for page, check in checks.items() if check.result()]
    print("\n".join(wrong) or f"{edits} edits fit, and {files} edited files compile")
    return 1 if wrong or not edits or not files else 0


if __name__ == "__main__":
    sys.exit(main())
