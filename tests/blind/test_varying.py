#!/usr/bin/python3
"""Tests the option for the run-to-run variation in the campaigns: their plans, the calls of the generators, the
ledgers and the pages."""
import argparse
import contextlib
import io
import pathlib
import sys
import tempfile
import unittest

HERE = pathlib.Path(__file__).resolve().parent
sys.path[:0] = [str(HERE), str(HERE / "textbook"), str(HERE.parents[1] / "scripts")]

import blind_campaign  # noqa: E402
import blind_page  # noqa: E402
import campaign  # noqa: E402
import changed_campaign  # noqa: E402
import changing  # noqa: E402
import judging  # noqa: E402
import textbook_campaign  # noqa: E402
import trial  # noqa: E402
import varying  # noqa: E402
from ledger import Ledger  # noqa: E402

IDS = ["valve_lag", "contact", "leak"]


def arguments(**given):
    usual = {"causes": None, "strengths": [8], "seeds": 2, "clean": 3, "outside": 1, "pairs": 1, "triples": 0,
             "first_seed": 5, "columns": ["pressure"], "given": ["plain"], "unchanged": 4}
    return argparse.Namespace(**{**usual, **given})


def plans(args):
    changed_campaign.causes_of, before = lambda *_: IDS, changed_campaign.causes_of
    try:
        return {"blind": list(blind_campaign.worlds(args, IDS, ["outside_bumps"])),
                "textbook": textbook_campaign.worlds(args, IDS, ["play", "preisach"]),
                "changed": changed_campaign.worlds(args, None)}
    finally:
        changed_campaign.causes_of = before


class Plans(unittest.TestCase):
    def test_cases_without_variation_have_no_variation_keys(self):
        for name, worlds in plans(arguments(variation=0.0, closed_loop=False, baseline_runs=[3])).items():
            with self.subTest(campaign=name):
                self.assertGreater(len(worlds), 3)
                self.assertFalse(any(key in world for world in worlds for key in varying.KEYS))

    def test_variation_adds_only_variation_keys_to_the_cases(self):
        plain = plans(arguments(variation=0.0, closed_loop=False, baseline_runs=[3]))
        for name, worlds in plans(arguments(variation=0.5, closed_loop=True, baseline_runs=[3])).items():
            with self.subTest(campaign=name):
                self.assertEqual([{**world, "variation": 0.5, "closed_loop": True} for world in plain[name]], worlds)

    def test_each_finger_is_planned_with_1_3_and_6_baseline_runs(self):
        worlds = plans(arguments(variation=1.0, baseline_runs=[1, 3, 6]))["changed"]
        runs = [world.pop("baseline_runs", 3) for world in worlds]
        self.assertEqual([runs.count(n) for n in (1, 3, 6)], [len(worlds) // 3] * 3)
        self.assertEqual(len({str(sorted(world.items())) for world in worlds}), len(worlds) // 3)


class Generators(unittest.TestCase):
    """Tests that the generator programs are called with the options for the variation of the world."""

    def called(self, function, *arguments_of):
        calls = []

        def run(command, **_):
            calls.append([str(word) for word in command])
            raise InterruptedError
        module = sys.modules[function.__module__]
        before, module.subprocess = module.subprocess, argparse.Namespace(run=run)
        try:
            with contextlib.suppress(InterruptedError):
                function(*arguments_of)
        finally:
            module.subprocess = before
        return calls[0]

    def test_variation_options_are_passed_to_both_generators(self):
        world = {"causes": [], "strength": 8, "seed": 1, "make": "play", "columns": "command"}
        with tempfile.TemporaryDirectory() as folder:
            for function, arguments_of in ((judging.run_world, (folder, folder)),
                                           (trial.make_logs, (folder, pathlib.Path(folder)))):
                plain = self.called(function, *arguments_of, world)
                varied = self.called(function, *arguments_of, {**world, "variation": 0.5, "closed_loop": True})
                self.assertNotIn("--variation", plain)
                self.assertEqual([word for word in varied if word.startswith("--")],
                                 [word for word in plain if word.startswith("--")] + ["--variation", "--closed-loop"])
                self.assertEqual(varied[varied.index("--variation") + 1], "0.5")

    def test_healthy_logs_of_a_changed_finger_are_recorded_in_open_loop(self):
        world = {"family": "first", "cause": "none", "strength": 0, "seed": 1, "columns": "command", "zero_mm": 0,
                 "warmer_c": 0, "variation": 1.0, "closed_loop": True, "baseline_runs": 6}
        healthy = self.called(changing.make, pathlib.Path("."), world, pathlib.Path("."))
        self.assertEqual(healthy[healthy.index("--runs") + 1], "6")
        self.assertIn("--variation", healthy)
        self.assertNotIn("--closed-loop", healthy)


class Records(unittest.TestCase):
    def test_rows_of_an_earlier_ledger_count_as_cases_without_variation(self):
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder) / "rows.jsonl"
            path.write_text('{"seed": 1, "outcome": "right"}\n')
            ledger = Ledger(path, ("seed", *varying.KEYS))
            self.assertIn({"seed": 1}, ledger)
            self.assertNotIn({"seed": 1, "variation": 1.0}, ledger)

    def test_a_page_has_only_rows_of_its_own_variation(self):
        rows = [{}, {"variation": 1.0}, {"variation": 1.0, "closed_loop": True}, {"variation": 0.5}]
        own = [row for row in rows if varying.belongs(row, arguments(variation=1.0))]
        self.assertEqual(own, [{"variation": 1.0}])
        self.assertEqual([row for row in rows if varying.belongs(row, arguments())], [{}])

    def test_the_page_states_the_variation_and_the_command(self):
        self.assertEqual(varying.text(arguments()), "The simulated fingers have no run-to-run variation.")
        self.assertIn("strength 0.5", varying.text(arguments(variation=0.5)))
        self.assertIn("closed loop", varying.text(arguments(variation=0.5, closed_loop=True)))
        parser = argparse.ArgumentParser()
        varying.add_options(parser, baseline_runs=True)
        args = parser.parse_args(["--variation", "0.5", "--closed-loop", "--baseline-runs", "1", "6"])
        args.page = "x.md"
        self.assertEqual(campaign.command("c.py", parser, args, ("variation", "closed_loop", "baseline_runs")),
                         "c.py --variation 0.5 --closed-loop --baseline-runs 1 6 --page x.md")

    def test_the_changed_page_counts_by_baseline_runs(self):
        def row(runs, strength, outcome, cause="leak"):
            world = {"family": "first", "cause": cause, "strength": strength, "seed": 1, "columns": "pressure",
                     "outcome": outcome, "verdict": "x", "named": [], "intervals": [], "variation": 1.0}
            return world if runs == 3 else {**world, "baseline_runs": runs}
        rows = [row(1, 1, "first"), row(1, 0.15, "missed"), row(3, 1, "first"), row(3, 0.15, "listed"),
                row(3, 0, "unchanged", "none")]
        def written(planned):
            return changed_campaign.page(rows, "command", planned, varying.text(arguments(variation=1.0)), "softgrip 0.1.0")

        page = written(5)
        self.assertNotIn("stopped before its end", page)
        self.assertIn("stopped before its end", written(6))
        self.assertIn("Run-to-run variation of strength 1:", page)
        self.assertIn("| 1 | 1 |\n| 3 | 0.15 |", page)

    def test_a_cause_that_is_absent_from_the_logs_counts_as_an_unchanged_finger(self):
        def row(change_mm, outcome, cause="sensor_saturation"):
            return {"family": "first", "cause": cause, "strength": 1, "seed": 1, "columns": "pressure", "outcome": outcome,
                    "verdict": "x", "named": [], "intervals": [], "recorded_change_mm": change_mm}
        rows = [row(0, "unchanged"), row(0, "false_alarm"), row(0.3, "first"), row(0.03, "missed"), row(0.05, "listed")]
        page = changed_campaign.page([*rows, {**row(0.03, "first"), "baseline_runs": 1}], "command", 6, "", "softgrip 0.1.0")
        self.assertIn("In 2 cases with a hidden cause, the later logs are the same", page)
        self.assertRegex(page, r"unchanged fingers that are reported as unchanged .* 50\.0 % .* \| 2 \|")
        self.assertRegex(page, r"strength 1: true cause named first .* 50\.0 % .* \| 4 \|")
        self.assertRegex(page, r"\| 0 to 1 times the noise \| 100\.0 % .*, 1 \| 0\.0 % .*, 1 \|")
        self.assertRegex(page, r"\| 4 to 8 times the noise \| - \| 100\.0 % .*, 1 \|")

    def test_the_blind_table_names_all_outcomes_of_a_column(self):
        rows = [{"causes": [], "strength": 0, "outcome": outcome} for outcome in ("right", "unexplained", "failed")]
        head, _, clean = blind_page.table(rows)
        cells = dict(zip(*([cell.strip() for cell in line.strip("|").split("|")] for line in (head, clean))))
        self.assertEqual((cells["right"], cells["missed, unexplained or failed"]), ("1", "2"))


class Help(unittest.TestCase):
    def test_the_help_of_every_campaign_lists_the_variation_options(self):
        for script in (blind_campaign, textbook_campaign, changed_campaign):
            with self.subTest(script=script.__name__):
                printed, words = io.StringIO(), sys.argv
                sys.argv = [script.__name__, "--help"]
                try:
                    with contextlib.redirect_stdout(printed), contextlib.suppress(SystemExit):
                        script.main()
                finally:
                    sys.argv = words
                self.assertIn("--variation", printed.getvalue())
                self.assertIn("--closed-loop", printed.getvalue())


if __name__ == "__main__":
    unittest.main()
