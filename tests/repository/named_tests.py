#!/usr/bin/env python3
"""Checks that every test to which a document refers exists: named_tests.py [--build BUILD_DIR]

A document names a test in inline code or in a code block. The name can be `Suite.Name` of GoogleTest,
`repository.name` of CTest, or `name_test`, a program or a file. In Python, the name is `test_module`,
`test_module.Class` or `test_module.Class.test_method`. `*` matches any text. A word `.Name*` refers to the suite of the
preceding word. The tests of CTest are read from BUILD_DIR.

With a build, also checks that every pattern of tests/CMakeLists.txt that gives tests a label selects a test of its
program.
"""

import argparse
import ast
import fnmatch
import pathlib
import re
import subprocess
import sys

import paths
import tree

GOOGLE = re.compile(r"\b(?:TYPED_)?TEST(?:_F|_P)?\(\s*(\w+),\s*(\w+)\s*\)")


def google_tests():
    names = set()
    for name in tree.names():
        if name.startswith("tests/") and name.endswith(".cpp"):
            names |= {f"{suite}.{test}" for suite, test in GOOGLE.findall((tree.ROOT / name).read_text())}
    return names


def python_tests():
    """Returns the names of the Python tests: module, module.Class and module.Class.test_method of every test_*.py,
    and the names of the methods without module and class."""
    names = set()
    for name in tree.names():
        file = tree.ROOT / name
        if not re.fullmatch(r"test_\w+\.py", file.name):
            continue
        names.add(file.stem)
        for node in ast.parse(file.read_text()).body:
            if isinstance(node, ast.ClassDef):
                names.add(f"{file.stem}.{node.name}")
                methods = [one.name for one in node.body if isinstance(one, ast.FunctionDef)]
                names |= {f"{file.stem}.{node.name}.{method}" for method in methods} | set(methods)
            elif isinstance(node, ast.FunctionDef):
                names |= {node.name, f"{file.stem}.{node.name}"}
    return names


def cmake_texts():
    return [(tree.ROOT / name).read_text() for name in tree.names()
            if name.startswith("tests/") and name.endswith("CMakeLists.txt")]


def ctest_tests(build):
    """Returns the names of the tests that CTest lists. Without a build, returns the names that are written out in a
    CMakeLists.txt. In the second case, * replaces each CMake variable in a name."""
    if build and (build / "CTestTestfile.cmake").exists():
        texts = [file.read_text() for file in (build / "tests").rglob("CTestTestfile.cmake")]
        return {name for text in texts for name in re.findall(r"^add_test\(\[=\[(.*?)\]=\]", text, re.MULTILINE)}
    names = {name for text in cmake_texts() for name in re.findall(r"add_test\(NAME (\S+)", text)}
    return {re.sub(r"\$\{\w+\}", "*", name) for name in names}


def test_programs():
    """Returns the names of the GoogleTest programs, and the names of the source files of these programs without the
    ending."""
    programs = {name for text in cmake_texts() for name in re.findall(r"softgrip_test\((\w+)", text)}
    stems = {pathlib.PurePosixPath(name).stem for name in tree.names()
             if re.search(r"_test\.(cpp|sh)$", name) or re.fullmatch(r"tests/.*_test\.py", name)}
    return programs | stems


def patterns_without_tests(build):
    """Returns a finding for each pattern of a label that selects no test of its program."""
    place = "tests/CMakeLists.txt"
    found = []
    for program, arguments in re.findall(r"^softgrip_test\((\w+)([^)]*)\)", (tree.ROOT / place).read_text(), re.MULTILINE):
        option = ""
        for word in arguments.split():
            if word.isupper():
                option = word
            elif option in ("REALTIME", "LONG", "CAMPAIGN"):
                told = subprocess.run([build / "tests" / program, "--gtest_list_tests", f"--gtest_filter={word}"],
                                      capture_output=True, text=True, check=True).stdout
                if not re.search(r"^  \w", told, re.MULTILINE):
                    found.append(f"{place}: `{word}`: {program} has no such test")
    return found


class Tests:
    def __init__(self, build):
        self.google, self.python, self.ctest = google_tests(), python_tests(), ctest_tests(build)
        self.programs = test_programs()

    def exists(self, word):
        """Returns True if the test exists, False if it does not, and None if the word is not the name of a test."""
        if re.fullmatch(r"[A-Z]\w*\*?\.[A-Z*][\w*]*|\*?[A-Z]\w*\*", word):
            return any(fnmatch.fnmatchcase(name, word) for name in self.google)
        if re.fullmatch(r"test_\w+(\.\w[\w*]*)*", word) and not word.endswith(".py"):
            return any(fnmatch.fnmatchcase(name, word) for name in self.python | self.ctest)
        if re.fullmatch(r"(repository|systemd)\.\w+", word):
            return any(fnmatch.fnmatchcase(word, name) or name.startswith(word + ".") for name in self.ctest)
        if re.fullmatch(r"(build/\w+/tests/)?\w+_test", word):
            return word.rsplit("/", 1)[-1] in self.programs
        return None


def findings_of(place, words, tests):
    found, suite = [], ""
    for number, word in words:
        if re.fullmatch(r"\.[A-Z][\w*]*", word) and suite:
            word = suite + word
        exists = tests.exists(word)
        if exists is None:
            continue
        suite = word.rsplit(".", 1)[0]
        if not exists:
            found.append(f"{place}:{number}: `{word}`: there is no such test")
    return found


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--build", type=pathlib.Path)
    build = parser.parse_args().build
    tests, findings, pages = Tests(build), patterns_without_tests(build) if build else [], paths.documents()
    for page in pages:
        text = page.read_text()
        made = paths.made_by_the_reader(page, text)
        words = ((number, word) for number, word in paths.words_of(text) if not made(word))
        findings += findings_of(page.relative_to(tree.ROOT), words, tests)
    print("\n".join(findings) or f"{len(pages)} documents and all labels: all named tests exist")
    return 1 if findings else 0


if __name__ == "__main__":
    sys.exit(main())
