#!/usr/bin/python3
"""Checks that the edits of the how-to pages fit the sources. The check makes the edits in a copy of the sources but
does not build the copy. `ctest -L recipe` makes the edits and builds the copy."""

import pathlib
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path[:0] = [str(ROOT / "tests" / "recipe")]

import add_a_cause  # noqa: E402
import recipe  # noqa: E402


def edits_of_the_cause(folder):
    """Makes all edits of docs/how-to/add-a-cause.md. Returns the number of edits. If an edit does not fit the sources,
    raises an AssertionError that describes the edit."""
    add_a_cause.copy_of(ROOT, folder)
    made = 0
    for language, info, body in add_a_cause.FENCE.findall((ROOT / add_a_cause.PAGE).read_text()):
        if language == "diff":
            add_a_cause.insert(folder / info.removeprefix("file="), body)
            made += 1
    return made


def main():
    with tempfile.TemporaryDirectory(prefix="softgrip-recipes-") as folder:
        try:
            of_command = recipe.Tree(folder).carry_out("docs/how-to/add-a-command.md")
            of_cause = edits_of_the_cause(pathlib.Path(folder) / "cause")
        except AssertionError as error:
            print(error, file=sys.stderr)
            return 1
    print(f"{of_command} edits of a command and {of_cause} of a cause fit")
    return 0 if of_command and of_cause else 1


if __name__ == "__main__":
    sys.exit(main())
