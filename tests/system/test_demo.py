"""Tests which output folders scripts/demo.sh accepts. A copy of the script runs with a replaced scripts/packages.sh that
ends the demo before the build."""

import pathlib
import shutil
import subprocess
import tempfile
import unittest

SOURCE = pathlib.Path(__file__).resolve().parents[2]
ACCEPTED = 77  # exit code of the replaced scripts/packages.sh


class OutputFolder(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.at = pathlib.Path(folder.name)
        (self.at / "tree/scripts").mkdir(parents=True)
        shutil.copy(SOURCE / "scripts/demo.sh", self.at / "tree/scripts")
        (self.at / "tree/scripts/packages.sh").write_text(f"exit {ACCEPTED}\n")
        self.out = self.at / "out"

    def demo(self, *arguments):
        return subprocess.run(["bash", self.at / "tree/scripts/demo.sh", *arguments], capture_output=True, text=True)

    def test_a_folder_with_other_files_is_refused(self):
        (self.out / "runs").mkdir(parents=True)
        (self.out / "thesis.txt").write_text("x")
        refused = self.demo(self.out)
        self.assertEqual(refused.returncode, 2, refused.stdout + refused.stderr)
        self.assertIn(f"{self.out} exists, but is not the output of a demo", refused.stderr)
        self.assertTrue((self.out / "thesis.txt").exists())

    def test_a_file_is_refused(self):
        self.out.write_text("x")
        self.assertEqual(self.demo(self.out).returncode, 2)

    def test_a_default_folder_with_other_files_is_refused(self):
        (self.at / "tree/demo-output").mkdir()
        (self.at / "tree/demo-output/x").write_text("x")
        self.assertEqual(self.demo().returncode, 2)

    def test_new_and_empty_folders_and_outputs_of_a_demo_are_accepted(self):
        self.assertEqual(self.demo(self.out).returncode, ACCEPTED)
        self.out.mkdir()
        self.assertEqual(self.demo(self.out).returncode, ACCEPTED)
        (self.out / ".softgrip-demo").touch()
        self.assertEqual(self.demo(self.out).returncode, ACCEPTED)
        (self.out / ".softgrip-demo").unlink()
        (self.out / "runs").mkdir()
        (self.out / "pick_stone.svg").touch()
        self.assertEqual(self.demo(self.out).returncode, ACCEPTED, "an earlier version has written this folder")


if __name__ == "__main__":
    unittest.main()
