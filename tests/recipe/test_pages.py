"""Executes the pages of docs/how-to that explain how to add a part, with the commands of these pages."""

import contextlib
import pathlib
import re
import subprocess
import tempfile
import time
import unittest

import recipe

BLOCK, BOARD, CAUSE, COMMAND = recipe.PAGES
# The board of the driver that docs/how-to/add-a-board.md adds. The driver has no watchdog.
EXAMPLE = """board:
  example: {mm_per_kpa: 0.3, exchange_deadline_s: 0.004, connect_deadline_s: 1, first_pause_s: 0.1, longest_pause_s: 2}"""
ACCEPTED = '"the outputs keep their last pressure when softgripd dies"'


class Pages(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="softgrip-recipe-")
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        self.place = recipe.Workplace(self.folder)

    def test_a_block(self):
        self.place.edit(BLOCK)
        self.place.run_commands(BLOCK)

    def test_a_board(self):
        self.place.edit(BOARD)
        self.place.run_commands(BOARD)
        rig = re.sub(r"board:\n  simulated:\n.*?\n\n", f"{EXAMPLE}\n\n", self.place.read("config/rig.yaml"), flags=re.DOTALL)
        rig = re.sub(r"safety:\n", f"safety:\n  accept_no_watchdog: {ACCEPTED}\n", rig)
        rig = re.sub(r"    pressure_monitor: .*\n|  pressure_monitor: .*\n", "", rig)
        with self.daemon(rig):
            self.wait_for("status", lambda text: "idle" in text and "example board" in text)

    def test_a_cause(self):
        """Without the lines in the list of causes, the compiler must print the message that the page quotes."""
        registry = "sysid/diagnosis/causes/registry.h"
        self.place.edit(CAUSE, lambda name: name != registry)
        refused = self.place.run("cmake --build build/release --target softgrip_sysid_diagnosis_causes", check=False)
        expected = [text.strip() for _, use, text in recipe.blocks_of(CAUSE) if use == "expect"]
        self.assertEqual(len(expected), 1)
        self.assertIn(expected[0], refused)
        self.place.edit(CAUSE, lambda name: name == registry)
        self.place.run_commands(CAUSE)

    def test_a_command(self):
        self.place.edit(COMMAND)
        self.place.run_commands(COMMAND)
        run = self.folder / "run"
        with self.daemon(self.place.read("config/rig.yaml"), "--record", run):
            self.wait_for("recording", lambda text: text == f"{run}\n")

    @contextlib.contextmanager
    def daemon(self, rig, *options):
        """Runs softgripd with the text of a rig file in config/."""
        self.place.write("config/rig_recipe.yaml", rig.replace("/tmp/softgrip.sock", str(self.folder / "socket")))
        program = ["build/release/daemon/softgripd", "--config", "config/rig_recipe.yaml", "--duration-s", "60"]
        with subprocess.Popen(self.place.command([*program, *options]), cwd=self.place.root,
                              stderr=subprocess.DEVNULL) as daemon:
            try:
                yield
            finally:
                daemon.terminate()

    def wait_for(self, command, accepted):
        """Repeats a command to the daemon until its output is accepted."""
        program = self.place.edited / "build/release/tools/softgrip"
        end = time.monotonic() + 30
        while time.monotonic() < end:
            asked = subprocess.run([program, *command.split(), "--socket", self.folder / "socket"], capture_output=True,
                                   text=True, check=False)
            if asked.returncode == 0 and accepted(asked.stdout):
                return
            time.sleep(0.1)
        self.fail(f"{command}: {asked.returncode}\n{asked.stdout}{asked.stderr}")


if __name__ == "__main__":
    unittest.main()
