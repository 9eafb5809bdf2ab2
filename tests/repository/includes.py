"""Checks that each source file includes the headers that declare the types it uses, directly or through other headers
of the project. A room is compiled as one file (SOFTGRIP_PRECOMPILE), so the compiler of this build does not find a
missing header. A build that compiles each file alone stops at the first missing header.

    includes.py
"""
import functools
import re
import sys

import tree
from tree import ROOT

ATTRIBUTE = r"(?:\[\[\w+\]\] |SOFTGRIP_API |alignas\(\w+\) )?"
DECLARED = re.compile(r"\b(?:(?:struct|class|enum class|enum|typename|concept)(?:\.\.\.)? " + ATTRIBUTE +
                      r"|using (?:\w+::)*|template <\S+ )([A-Z]\w+)")
TEST_NAME = re.compile(r"^(?:TEST|TEST_P|INSTANTIATE_TEST_SUITE_P)\([^)]*\)?", re.M)
# the standard header of names in namespace std
STANDARD = {name: header for header, names in {
    "algorithm": "min_element max_element stable_sort", "array": "array", "atomic": "atomic", "chrono": "chrono",
    "filesystem": "filesystem", "functional": "function", "map": "map", "memory": "unique_ptr make_unique shared_ptr",
    "mutex": "mutex", "optional": "optional nullopt", "set": "set", "span": "span", "thread": "thread",
    "tuple": "tuple", "variant": "variant", "vector": "vector"}.items() for name in names.split()}


def code_of(text):
    """Returns a C++ text without comments, the content of string literals and the names of tests."""
    text = re.sub(r'R"(\w*)\(.*?\)\1"|"(?:[^"\\\n]|\\.)*"', '""', text, flags=re.S)
    return TEST_NAME.sub("", re.sub(r"//[^\n]*|/\*.*?\*/", "", text, flags=re.S))


class Sources:
    def __init__(self):
        self.names = [name for name in tree.names() if name.endswith((".h", ".cpp"))]
        text = {name: (ROOT / name).read_text() for name in self.names}
        self.known = set(self.names)
        self.includes = {name: re.findall(r'^#include ["<]([^">]+)[">]', text[name], re.M) for name in self.names}
        self.code = {name: code_of(text[name]) for name in self.names}

    def header(self, name, included):
        """Returns the project file that the file `name` includes as `included`; None: a header of another project.
        Public headers of the library are included by their installed path. The files of a test program may include each
        other by their plain names."""
        folder = name.rpartition("/")[0]
        for path in (included, f"{folder}/{included}", f"{folder.rpartition('/')[0]}/{included}",
                     f"library/include/{included}"):
            if path in self.known:
                return path
        return None

    @functools.cache
    def reached(self, name):
        """Returns all files and all headers of other projects that the file includes, directly or indirectly."""
        seen, waiting = set(), [name]
        while waiting:
            one = waiting.pop()
            for included in self.includes.get(one, []):
                found = self.header(one, included) or included
                if found not in seen:
                    seen.add(found)
                    waiting.append(found)
        return frozenset(seen)


def missing(sources):
    """Returns a message for each type that a file uses although no file that it includes declares this type."""
    declared = {name: set(DECLARED.findall(sources.code[name])) for name in sources.names}
    homes = {one: name for name in sources.names if name.endswith(".h") for one in declared[name]}
    for name in sources.names:
        reached = sources.reached(name) | {name}
        visible = set().union(*(declared.get(file, set()) for file in reached))
        for used in sorted(set(re.findall(r"(?<![.>:\w])([A-Z]\w*[a-z]\w*)\b", sources.code[name])) & homes.keys() - visible):
            yield f"{name}: uses {used}, but does not include {homes[used]}"
        for used in sorted(set(re.findall(r"\bstd::(\w+)", sources.code[name])) & STANDARD.keys()):
            if STANDARD[used] not in reached:
                yield f"{name}: uses std::{used}, but does not include <{STANDARD[used]}>"


def main():
    sources = Sources()
    findings = list(missing(sources))
    print("\n".join(findings) or f"{len(sources.names)} files include the headers of the types that they use")
    return 1 if findings or not sources.names else 0


if __name__ == "__main__":
    sys.exit(main())
