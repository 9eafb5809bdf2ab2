"""Tests recipes with arguments, the list of recipes, and the message about a mistyped name, as a user sees them."""

import json
import os
import re
import shutil
import subprocess
import unittest

import bench

PICK = "config/sequences/pick_stone.yaml"


def simulated_rig(folder):
    """Writes the shipped simulated rig file. Its socket and its recordings are in the folder of the test."""
    text = (folder / "config/rig.yaml").read_text()
    for pattern, replacement in ((r"directory: /tmp/softgrip-runs", f"directory: {folder}/runs"),
                                 (r"path: /tmp/softgrip.sock", f"path: {folder}/softgripd.sock"),
                                 (r"real_time: .*", "real_time: {required: false, priority: 70, cpus: [], "
                                                    "lock_memory: false}")):
        text, count = re.subn(pattern, replacement, text)
        assert count > 0, pattern
    path = folder / "config/test_rig.yaml"
    path.write_text(text)
    return path


class WithoutADaemon(bench.BenchTest):
    def test_run_applies_parameters_and_the_recording_states_them(self):
        self.softgrip("run", PICK, "--set", "squeeze_kpa=4", "--set", "hold_s=0.5", "--virtual-time", "--quiet",
                      "--record", "asked")
        self.softgrip("run", PICK, "--virtual-time", "--quiet", "--record", "plain")
        asked, plain = (json.loads((self.folder / name / "run.json").read_text()) for name in ("asked", "plain"))
        self.assertEqual(asked["sequence"]["parameters"], {"squeeze_kpa": 4, "hold_s": 0.5})
        self.assertEqual(plain["sequence"]["parameters"], {"squeeze_kpa": 5, "hold_s": 5})
        started = next(event for event in asked["events"] if event["kind"] == "sequence_started")
        self.assertEqual(started["parameters"], {"squeeze_kpa": 4, "hold_s": 0.5})
        self.assertIn("begins with squeeze_kpa 4, hold_s 0.5.", started["text"])
        self.assertLess(asked["duration_s"], plain["duration_s"] - 4,
                        "the sequence must be shorter with the shorter hold_s")

    def test_invalid_parameters_are_rejected_before_the_run(self):
        def refused(*settings, expect=3):
            options = [word for setting in settings for word in ("--set", setting)]
            return self.softgrip("run", PICK, *options, "--virtual-time", "--record", "r", expect=expect).stderr

        self.assertIn("did you mean `squeeze_kpa`?", refused("squeze_kpa=4"))
        self.assertRegex(refused("squeeze_kpa=11"), r"pick_stone\.yaml:\d+:3: `squeeze_kpa` is set to 11, outside its range of")
        self.assertIn("the decimal mark is a point: 4.5", refused("squeeze_kpa=4,5", expect=2))
        self.assertIn("NAME=VALUE", refused("squeeze_kpa", expect=2))
        self.assertFalse((self.folder / "r").exists())

    def test_check_tests_both_ends_of_a_parameter_range(self):
        self.softgrip("check", "config/rig.yaml", PICK)
        self.softgrip("check", "config/rig.yaml", PICK, "--set", "squeeze_kpa=10")
        recipe = (self.folder / PICK).read_text()
        self.write("weak.yaml", recipe.replace("range: [3, 10]", "range: [0.5, 10]"))
        weak = self.softgrip("check", "config/rig.yaml", "weak.yaml", expect=3).stderr
        self.assertRegex(weak, r"weak\.yaml:9:3: with `squeeze_kpa` = 0\.5, the lower end of its range, line \d+ is "
                               r"wrong: step 'grip': grips with 0\.5 kPa, but channel 'left' detects")
        # The check without a rig must accept this grip, because some rigs can detect it.
        self.softgrip("check", "weak.yaml")
        self.write("strong.yaml", recipe.replace("range: [3, 10]", "range: [3, 12]"))
        self.assertIn("squeeze_max_kpa is below squeeze_kpa", self.softgrip("check", "strong.yaml", expect=3).stderr)
        self.assertIn("has no parameter", self.softgrip("check", PICK, "--set", "a=1", expect=3).stderr)

    def test_a_misspelled_word_gives_a_suggestion(self):
        self.assertIn("did you mean `status`?", self.softgrip("statsu", expect=2).stderr)
        self.assertIn("did you mean `--json`?", self.softgrip("status", "--jsno", expect=2).stderr)
        process = bench.Process("rig", [bench.SOFTGRIP_RIG, "--model", "config/models/bench_twin.yaml", "--board",
                                        "adam-6042", "--tcp", "0"], self.folder)
        self.processes.append(process)
        self.assertEqual(process.wait(), 4)
        self.assertIn("did you mean adam-6024?", process.errors())

    def test_an_existing_recording_ends_run_before_any_motion(self):
        self.softgrip("run", PICK, "--virtual-time", "--quiet", "--record", "r")
        before = (self.folder / "r/run.json").read_text()
        again = self.softgrip("run", PICK, "--virtual-time", "--quiet", "--record", "r", expect=5)
        self.assertIn("r/run.csv exists already; a recording is never overwritten", again.stderr)
        self.assertEqual(again.stdout, "")
        self.assertEqual((self.folder / "r/run.json").read_text(), before)

    def test_run_messages_name_softgrip_run_and_not_softgripd(self):
        done = self.softgrip("run", PICK, "--virtual-time", "--record", "r")
        self.assertNotIn("softgripd", done.stderr)
        self.assertIn("softgrip run 0.", done.stderr)
        self.assertNotIn("none_yet", done.stdout, "a missing first reading must cause no warning")

    def test_the_completion_scripts_offer_all_commands(self):
        script = self.write("completion.bash", self.softgrip("completion", "bash").stdout)
        (self.folder / "bin").mkdir()
        (self.folder / "bin/softgrip").symlink_to(bench.SOFTGRIP)

        def offered(*words):
            quoted = " ".join(f"'{word}'" for word in words)
            done = subprocess.run(
                ["bash", "-c", f"PATH={self.folder}/bin:$PATH; source {script}; COMP_WORDS=({quoted}); "
                               f"COMP_CWORD={len(words) - 1}; _softgrip; printf '%s\\n' \"${{COMPREPLY[@]}}\""],
                capture_output=True, text=True, timeout=bench.PATIENCE_S, cwd=self.folder, check=True)
            self.assertEqual(done.stderr, "")
            return done.stdout.split()

        self.assertEqual(offered("softgrip", "st"), ["study", "status", "start", "stop"])
        self.assertIn("--set", offered("softgrip", "start", "--"))
        self.assertEqual(offered("softgrip", "events", "--severity", "w"), ["warning"])
        help_text = self.softgrip("--help").stdout
        commands = re.findall(r"^  ([a-z]+) {2,}\S", help_text.split("Subcommands:")[1], re.MULTILINE)
        self.assertEqual(sorted(offered("softgrip", "")), sorted(commands))
        for shell, parse in (("zsh", ["zsh", "-n"]), ("fish", ["fish", "--no-execute"])):
            text = self.softgrip("completion", shell).stdout
            for command in commands:
                self.assertIn(command, text)
            if shutil.which(parse[0]):
                subprocess.run([*parse, self.write(f"completion.{shell}", text)], check=True)

    def test_the_completion_scripts_are_installed_for_three_shells(self):
        install = (bench.BUILD / "cmake_install.cmake").read_text()
        for place in ("bash-completion/completions", "zsh/vendor-completions", "fish/vendor_completions.d"):
            self.assertIn(place, install)


class WithADaemon(bench.BenchTest):
    def setUp(self):
        super().setUp()
        self.rig_path = simulated_rig(self.folder)
        self.softgripd = self.idle_daemon(self.rig_path)

    def test_the_sequence_list_states_parameters_and_problems(self):
        self.write("config/sequences/broken.yaml", "name: broken\nstep: []\n")
        text = self.softgrip("sequences").stdout
        self.assertRegex(text, r"squeeze_kpa +3 to 10 kPa, default 5: gripping pressure")
        self.assertIn("hand_over: ", text)
        self.assertIn("broken.yaml:2:1: unknown key `step`", text)
        listed = {entry["name"]: entry for entry in
                  json.loads(self.softgrip("sequences", "--json").stdout)["sequences"]}
        self.assertEqual(listed["pick_stone"]["parameters"][0],
                         {"name": "squeeze_kpa", "unit": "kpa", "lower": 3, "upper": 10, "default": 5,
                          "about": "gripping pressure on the stone"})
        self.assertEqual(listed["broken"]["problems"][0]["line"], 2)
        names = self.softgrip("sequences", "--names").stdout.split()
        self.assertEqual(names, sorted(path.stem for path in (self.folder / "config/sequences").glob("*.yaml")))

    def test_start_takes_parameters(self):
        self.softgrip("start", "pick_stone", "--set", "squeeze_kpa=4", "--set", "hold_s=600")
        self.assertEqual(self.softgripd.status()["sequence"]["parameters"], {"squeeze_kpa": 4, "hold_s": 600})
        event = self.softgripd.wait_for_event("sequence_started")
        self.assertEqual(event["parameters"], {"squeeze_kpa": 4, "hold_s": 600})
        self.assertIn("with squeeze_kpa 4, hold_s 600", self.softgrip("events").stdout)
        self.softgrip("vent")

    def test_a_refused_start_states_valid_sequences_and_parameters(self):
        unknown = self.softgrip("start", "nope", expect=3).stderr
        self.assertIn("there is no sequence 'nope'", unknown)
        self.assertIn("hand_over, pick_screw, pick_stone", unknown)
        self.assertIn("did you mean 'pick_stone'?", self.softgrip("start", "pick_stne", expect=3).stderr)
        file = self.softgrip("start", "pick_stne.yaml", expect=3).stderr
        self.assertIn("there is no such file", file)
        self.assertIn("did you mean 'pick_stone'?", file)
        self.assertNotIn(".yaml.yaml", file)
        named = self.softgrip("run", "pick_stone", expect=4).stderr
        self.assertIn("`softgrip run` needs the path of a sequence file", named)
        wrong = self.softgrip("start", "pick_stone", "--set", "squeeze_kpa=40", expect=3).stderr
        self.assertRegex(wrong, r"pick_stone\.yaml:9:3: `squeeze_kpa` is set to 40, outside its range of 3 to 10")
        self.assertIn("did you mean `hold_s`?", self.softgrip("start", "pick_stone", "--set", "hold=1",
                                                            expect=3).stderr)
        self.assertEqual(self.softgripd.status()["state"], "idle")

    def test_the_option_rig_selects_the_daemon(self):
        other = {"SOFTGRIP_SOCKET": "/nowhere"}
        for command in ("status", "sequences", "events"):
            done = subprocess.run([bench.SOFTGRIP, command, "--rig", self.rig_path], capture_output=True, text=True,
                                  env=other, timeout=bench.PATIENCE_S, check=False)
            self.assertEqual((done.returncode, done.stderr), (0, ""), command)
        self.softgrip("status", "--rig", "absent.yaml", expect=4)
        self.assertIn("does not name a socket", self.softgrip("status", "--rig", PICK, expect=3).stderr)
        self.softgrip("status", "--rig", self.rig_path, "--socket", "x", expect=2)

    def test_the_first_reading_causes_no_warning(self):
        self.assertEqual([event["text"] for event in self.softgripd.events() if event["severity"] != "information"], [])

    def test_start_reports_a_local_file_that_cannot_be_read(self):
        self.assertIn("No such file or directory", self.softgrip("start", "nowhere/pick_stone.yaml", expect=4).stderr)
        self.assertIn("config/sequences", self.softgrip("start", "config/sequences", expect=4).stderr)
        os.mkfifo(self.folder / "pipe")
        self.assertIn("pipe", self.softgrip("start", "pipe", expect=4).stderr)
        self.assertEqual(self.softgripd.status()["state"], "idle")

    def test_start_sends_the_name_of_a_sequence_although_a_local_folder_has_this_name(self):
        (self.folder / "pick_stone").mkdir()
        self.softgrip("start", "pick_stone")
        self.softgrip("vent")

    def test_run_while_a_daemon_runs_writes_nothing_to_the_board(self):
        done = self.softgrip("run", PICK, "--rig", self.rig_path, expect=5)
        self.assertIn("softgripd runs and controls the board: first stop softgripd", done.stderr)
        self.assertIn("nothing was written to the board", done.stdout)
        told = self.softgrip("run", PICK, "--rig", self.rig_path, "--json", expect=5).stdout
        self.assertEqual(json.loads(told)["sequence_end"], "not run")
        self.assertNotIn("NOT confirm", done.stdout)


if __name__ == "__main__":
    unittest.main()
