"""Checks the board map of docs/how-to/add-a-board.md and uses it for exchanges. tests/recipe adds the driver of this
page."""

import pathlib
import re
import sys

import bench

sys.path.insert(0, str(bench.SOURCE / "tests" / "recipe"))
import recipe  # noqa: E402

PAGE = "docs/how-to/add-a-board.md"


class AddABoard(bench.BenchTest):
    def test_a_new_modbus_board_needs_only_a_board_map(self):
        path = "config/boards/example-4x2.yaml"
        self.write(path, recipe.new_file(PAGE, path))
        example = ((r"map: .*", "map: boards/example-4x2.yaml"),
                   (r"pressure_monitor: {input: 4", "pressure_monitor: {input: 2"),
                   (r"pressure_monitor: {input: 5", "pressure_monitor: {input: 3"))
        rig = self.rig(1502, example)
        self.assertIn("ok", self.softgrip("check", rig).stdout)
        emulator = self.emulator("--rig", rig, board=None)
        daemon = self.idle_daemon(self.rig(emulator.port, example))
        daemon.start("pick_stone")
        bench.wait_for("pressure in both fingers", lambda: min(emulator.commands_kpa()) > 5)
        emulator.end()
        bench.wait_for("the loss to be seen", lambda: not daemon.status()["bus"]["connected"])

    def test_every_file_named_by_the_page_exists(self):
        for path in re.findall(r"`((?:[\w.-]+/)+[\w-]+\.\w+)`", (bench.SOURCE / PAGE).read_text()):
            if "example" not in pathlib.Path(path).name:
                self.assertTrue((bench.SOURCE / path).exists(), path)


if __name__ == "__main__":
    bench.main()
