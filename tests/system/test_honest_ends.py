"""Tests that a failed check is visible in the output, for a person, and in the exit code, for a program."""

import bench
import terminal

MODEL = "config/models/zhang2025.yaml"
RED = b"\x1b[1;31m"


class Validate(bench.BenchTest):

    def setUp(self):
        super().setUp()
        for signal in ("tp1", "steps"):
            self.softgrip("simulate", "--model", "config/models/bench_twin.yaml", "--input", signal, "--out",
                          f"{signal}.csv", "--noise-mm", "0.05", "--seed", "3")

    def on_terminal(self, percent, **environment):
        screen = terminal.Terminal([bench.SOFTGRIP, "validate", "--model", MODEL, "--data", "tp1.csv", "steps.csv",
                                    "--at-most-percent", percent], self.folder, columns=200, environment=environment)
        bench.wait_for("validate to end", lambda: (screen.read(), screen.child.poll() is not None)[1])
        screen.read()
        return screen.child.returncode, screen.raw.splitlines()

    def test_validate_prints_failed_logs_in_red_on_a_terminal(self):
        code, lines = self.on_terminal("0.4")
        self.assertEqual(code, 6)
        of = {name: next(line for line in lines if name in line) for name in (b"tp1 ", b"steps ", b"zhang2025 predicts")}
        self.assertIn(RED, of[b"steps "])
        self.assertIn(b"FAILED: above 0.4 %", of[b"steps "])
        self.assertIn(RED, of[b"zhang2025 predicts"])
        self.assertNotIn(RED, of[b"tp1 "])
        self.assertEqual(self.on_terminal("0.4", NO_COLOR="1")[1], [line.replace(RED, b"").replace(b"\x1b[0m", b"")
                                                                   for line in lines])
        code, lines = self.on_terminal("2")
        self.assertEqual(code, 0)
        self.assertNotIn(RED, b"\n".join(lines))


if __name__ == "__main__":
    bench.main()
