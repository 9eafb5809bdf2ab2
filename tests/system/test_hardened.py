"""Tests that every build of the programs has the hardening options. The build for the package is one of these
builds."""

import platform
import re
import subprocess
import unittest

import bench

PROGRAMS = [bench.SOFTGRIPD, bench.SOFTGRIP, bench.SOFTGRIP_RIG, bench.BUILD / "tools/softgrip-plc",
            bench.BUILD / "tools/softgrip-web"]
ENDBR64 = bytes.fromhex("f30f1efa")


def cache(name):
    found = re.search(rf"^{name}(:\w+)?=(.*)$", (bench.BUILD / "CMakeCache.txt").read_text(), re.MULTILINE)
    return found.group(2) if found else ""


@unittest.skipIf(cache("SOFTGRIP_SANITIZE"), "a build with a sanitizer has its own checks")
class Hardened(unittest.TestCase):
    def read(self, program, *what):
        return subprocess.run(["readelf", "-W", *what, program], capture_output=True, text=True, check=True).stdout

    def test_every_program_has_the_hardening_options(self):
        for program in PROGRAMS:
            with self.subTest(program=program.name):
                symbols = self.read(program, "--dyn-syms")
                self.assertIn("__stack_chk_fail", symbols, "-fstack-protector-strong")
                if cache("CMAKE_BUILD_TYPE") != "Debug":  # _FORTIFY_SOURCE has an effect in optimised builds only
                    self.assertRegex(symbols, r"__(memcpy|read|printf|snprintf|vsnprintf|poll)_chk", "_FORTIFY_SOURCE")
                self.assertIn("BIND_NOW", self.read(program, "-d"))
                self.assertIn("GNU_RELRO", self.read(program, "-l"))
                self.assertIn("DYN (Pos", self.read(program, "-h"))
                if platform.machine() == "x86_64":
                    self.assertGreater(program.read_bytes().count(ENDBR64), 1000, "-fcf-protection")


if __name__ == "__main__":
    bench.main()
