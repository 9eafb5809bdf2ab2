"""Tests that the type annotations of the package and of the examples are correct."""

import os
import subprocess
import unittest

import package


class Types(unittest.TestCase):
    def test_mypy_reports_no_error_in_package_and_examples(self):
        done = subprocess.run(["/usr/bin/mypy", "--strict", "--cache-dir", os.devnull, "python/softgrip",
                               "python/examples", "examples/python"], cwd=package.SOURCE, capture_output=True, text=True,
                              env={**os.environ, "MYPYPATH": "python"})
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)


if __name__ == "__main__":
    unittest.main()
