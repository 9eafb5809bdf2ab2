"""Executes the steps of docs/how-to/add-a-board.md. The test checks the board map of the page, uses it for exchanges,
and compiles the driver."""

import pathlib
import re
import shutil
import subprocess

import bench

PAGE = bench.SOURCE / "docs" / "how-to" / "add-a-board.md"


def block_of(path):
    """Returns the code on the page for this file."""
    found = re.search(rf"`{re.escape(path)}`:\n\n```\w+\n(.*?)```\n", PAGE.read_text(), re.DOTALL)
    if found is None:
        raise AssertionError(f"{PAGE} gives no content of {path}")
    return found.group(1)


class AddABoard(bench.BenchTest):
    def test_a_new_modbus_board_needs_only_a_board_map(self):
        path = "config/boards/example-4x2.yaml"
        self.write(path, block_of(path))
        example = ((r"map: .*", "map: boards/example-4x2.yaml"),
                   (r"pressure_monitor: {input: 4", "pressure_monitor: {input: 2"),
                   (r"pressure_monitor: {input: 5", "pressure_monitor: {input: 3"))
        rig = self.rig(1502, example)
        self.assertIn("ok", self.softgrip("check", rig).stdout)
        emulator = self.emulator("--rig", rig, board=None)
        daemon = self.daemon(self.rig(emulator.port, example))
        daemon.wait_for_state("idle")
        daemon.start("pick_stone")
        bench.wait_for("pressure in both fingers", lambda: min(emulator.commands_kpa()) > 5)
        emulator.end()
        bench.wait_for("the loss to be seen", lambda: not daemon.status()["bus"]["connected"])

    def test_the_example_driver_of_the_page_compiles(self):
        compiler = next(filter(None, map(shutil.which, ("c++", "g++", "clang++"))), None)
        if compiler is None:
            self.skipTest("no compiler is installed")
        path = self.write("example_board.cpp", block_of("drivers/example/example_board.h").replace("#pragma once\n", "") +
                          "softgrip::drivers::ExampleBoard board({});\n")
        subprocess.run([compiler, "-std=c++20", "-Wall", "-Wextra", "-Werror", "-fsyntax-only", "-I", bench.SOURCE, path],
                       check=True, timeout=bench.PATIENCE_S)

    def test_every_file_named_by_the_page_exists(self):
        for path in re.findall(r"`((?:[\w.-]+/)+[\w-]+\.\w+)`", PAGE.read_text()):
            if "example" not in pathlib.Path(path).name:
                self.assertTrue((bench.SOURCE / path).exists(), path)


if __name__ == "__main__":
    bench.main()
