"""Executes the steps of docs/how-to/add-a-command.md in a copy of the source tree."""

import pathlib
import subprocess
import tempfile
import time
import unittest

import recipe


class AddACommand(unittest.TestCase):
    def test_the_page_gives_a_command_that_works(self):
        with tempfile.TemporaryDirectory(prefix="softgrip-recipe-") as folder:
            tree = recipe.Tree(folder)
            self.assertEqual(tree.carry_out("docs/how-to/add-a-command.md"), 12)
            tree.make("softgrip", "softgripd", "daemon_test")
            tree.run(["ctest", "--test-dir", "build/release", "-R", "ClientRequest", "--no-tests=error"])
            self.assertIn("recording", tree.run(["build/release/tools/softgrip", "--help"]))
            self.ask_a_daemon(tree, pathlib.Path(folder))

    def ask_a_daemon(self, tree, folder):
        socket = folder / "socket"
        rig = tree.folder / "config" / "rig.yaml"
        rig.write_text(rig.read_text().replace("/tmp/softgrip.sock", str(socket)))
        daemon = subprocess.Popen([tree.build / "daemon" / "softgripd", "--config", rig, "--record", folder / "run",
                                   "--duration-s", "60"], stderr=subprocess.DEVNULL)
        try:
            command = [tree.build / "tools" / "softgrip", "recording", "--socket", socket]
            end = time.monotonic() + 30
            while time.monotonic() < end:
                asked = subprocess.run(command, capture_output=True, text=True, check=False)
                if asked.stdout == f"{folder / 'run'}\n":
                    break
                time.sleep(0.1)
            self.assertEqual((asked.returncode, asked.stdout), (0, f"{folder / 'run'}\n"), asked.stderr)
        finally:
            daemon.terminate()
            daemon.wait()


if __name__ == "__main__":
    unittest.main()
