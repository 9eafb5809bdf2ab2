"""Tests which output folders scripts/demo.sh accepts, and how it deletes their content. A copy of the script runs with
replaced scripts and programs, which end the demo before the build or after the deletion."""

import os
import pathlib
import shutil
import subprocess
import tempfile
import unittest

SOURCE = pathlib.Path(__file__).resolve().parents[2]
ACCEPTED = 77  # exit code of the replaced script that ends the demo


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
        return subprocess.run(["bash", self.at / "tree/scripts/demo.sh", *arguments], capture_output=True, text=True,
                              env={**os.environ, "PATH": f"{self.at / 'bin'}:{os.environ['PATH']}"})

    def program(self, name, text):
        (self.at / "bin").mkdir(exist_ok=True)
        (self.at / "bin" / name).write_text(f"#!/bin/bash\n{text}\n")
        (self.at / "bin" / name).chmod(0o755)

    def end_after_deletion(self):
        """Replaces the build, so that the demo ends after the deletion and before its first step."""
        (self.at / "tree/scripts/packages.sh").write_text("")
        self.program("cmake", "mkdir -p build/demo && touch build/demo/CMakeCache.txt")
        self.program("python3", "")
        (self.at / "tree/scripts/rig_session.sh").write_text(f"exit {ACCEPTED}\n")

    def names(self):
        return sorted(path.name for path in self.out.iterdir())

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

    def test_an_output_of_an_earlier_version_is_accepted(self):
        (self.out / "runs").mkdir(parents=True)
        self.assertEqual(self.demo(self.out).returncode, ACCEPTED, "an earlier version stopped early")
        for name in ("baseline", "health"):
            (self.out / name).mkdir()
        (self.out / "tp1.csv").touch()
        self.assertEqual(self.demo(self.out).returncode, 2, "no picture: this can be the folder of another program")
        (self.out / "pick_stone.svg").touch()
        self.assertEqual(self.demo(self.out).returncode, ACCEPTED)
        for name in ("thesis.txt", ".git", "runs 2"):
            (self.out / name).touch()
            self.assertEqual(self.demo(self.out).returncode, 2, name)
            (self.out / name).unlink()

    def test_an_old_output_is_deleted(self):
        self.end_after_deletion()
        (self.out / "runs/old").mkdir(parents=True)
        for name in (".softgrip-demo", "pick_stone.svg", ".hidden"):
            (self.out / name).touch()
        done = self.demo(self.out)
        self.assertEqual(done.returncode, ACCEPTED, done.stderr)
        self.assertEqual(self.names(), [".softgrip-demo", "runs"])
        self.assertEqual(list((self.out / "runs").iterdir()), [])

    def test_a_demo_that_is_interrupted_in_the_deletion_can_be_repeated(self):
        self.end_after_deletion()
        (self.out / "runs").mkdir(parents=True)
        for name in (".softgrip-demo", "pick_stone.svg", "later_version.csv"):
            (self.out / name).touch()
        self.program("rm", f"/bin/rm -rf '{self.out}/pick_stone.svg'; exit 1")
        self.assertNotIn(self.demo(self.out).returncode, (0, 2, ACCEPTED))
        self.assertNotIn("pick_stone.svg", self.names())
        (self.at / "bin/rm").unlink()
        self.assertEqual(self.demo(self.out).returncode, ACCEPTED)
        self.assertEqual(self.names(), [".softgrip-demo", "runs"])

    def test_a_folder_that_is_filled_during_the_build_is_not_deleted(self):
        self.end_after_deletion()
        (self.at / "tree/scripts/packages.sh").write_text(f"mkdir '{self.out}'; touch '{self.out}/thesis.txt'\n")
        self.assertEqual(self.demo(self.out).returncode, 2)
        self.assertEqual(self.names(), ["thesis.txt"])


if __name__ == "__main__":
    unittest.main()
