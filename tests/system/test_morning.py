"""Executes the session of docs/how-to/a-morning.md. The screen must show the same text as the page."""

import subprocess
import sys
import unittest

import bench


class Morning(unittest.TestCase):
    def test_the_page_shows_the_current_output_of_the_session(self):
        played = subprocess.run([sys.executable, bench.SOURCE / "scripts/morning.py", "--build", bench.BUILD,
                                 "--check", bench.SOURCE / "docs/how-to/a-morning.md"],
                                capture_output=True, text=True, timeout=170)
        self.assertEqual(played.returncode, 0,
                         f"the page is out of date. Update it with: scripts/morning.py --page\n{played.stdout}\n"
                                               f"{played.stderr}")


if __name__ == "__main__":
    unittest.main()
