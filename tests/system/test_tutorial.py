"""Executes the tutorial in docs/tutorial: runs the commands in the code blocks of the pages."""

import html
import json
import os
import re
import resource
import shutil
import signal
import socket
import subprocess
import sys
import time
import unittest

import bench
import printing

FENCE = re.compile(r"^```\n(.*?)^```$", re.MULTILINE | re.DOTALL)


def fences(page):
    """Returns the commands of the page, one string for each code block."""
    return FENCE.findall((bench.SOURCE / "docs/tutorial" / page).read_text(encoding="utf-8"))


class FirstRun(bench.BenchTest):
    """Tests docs/tutorial/first-run.md. The test changes only the port, the socket and the folder of recordings in
    the commands, because other tests run at the same time. It also uses longer time limits for a busy machine."""

    def setUp(self):
        super().setUp()
        with socket.socket() as free:
            free.bind(("127.0.0.1", 0))
            port = free.getsockname()[1]
        self.rig(port).rename(self.folder / "config/rig_tcp.yaml")
        self.build, self.rig_words, self.daemon_words, self.session, self.desk = fences("first-run.md")
        self.environment = {
            **os.environ, "PATH": f"{bench.BUILD}/tools:{bench.BUILD}/daemon:{os.environ['PATH']}",
            "SOFTGRIP_SOCKET": f"{self.folder}/softgripd.sock"}

    def said(self, words):
        return words.replace("/tmp/softgrip.sock", f"{self.folder}/softgripd.sock").replace(
            "/tmp/softgrip-runs", f"{self.folder}/runs")

    def beside(self, name, words):
        """Starts a command that, according to the page, runs in its own terminal."""
        line = f"PATH={self.environment['PATH']}; exec {self.said(words).strip()}"
        process = bench.Process(name, ["bash", "-c", line], self.folder)
        self.processes.append(process)
        return process

    def shell(self, words, timeout_s=bench.PATIENCE_S):
        done = subprocess.run(["bash", "-euo", "pipefail", "-c", self.said(words)], cwd=self.folder, text=True,
                              capture_output=True, timeout=timeout_s, env=self.environment)
        self.assertEqual(done.returncode, 0, f"{words}\n{done.stdout}\n{done.stderr}")
        return done.stdout

    def status(self):
        """Returns the status of the daemon. Returns {} if the daemon does not answer."""
        done = subprocess.run([bench.SOFTGRIP, "status", "--json"], cwd=self.folder, text=True, capture_output=True,
                              env=self.environment)
        return json.loads(done.stdout) if done.returncode == 0 else {}

    def state(self):
        return self.status().get("state")

    def wait_for_state(self, state):
        bench.wait_for(f"state {state}", lambda: self.state() == state)

    def test_the_grip_commands_of_the_tutorial_work(self):
        self.assertIn("export PATH=$PWD/build/release/tools", self.build)
        rig = self.beside("softgrip-rig", self.rig_words)
        bench.wait_for("the rig", lambda: "listening" in rig.output())
        self.beside("softgripd", self.daemon_words)
        self.wait_for_state("idle")
        said = self.shell(self.session)
        for word in re.search(r"# (\w+), then (\w+)", self.session).groups():
            self.assertIn(word, said, "the page must show this with `softgrip start`")
        self.assertTrue((self.folder / "pick.svg").read_text().startswith("<svg"))
        rig.end(signal.SIGINT)
        self.wait_for_state("faulted")
        rig = self.beside("softgrip-rig-again", self.rig_words)
        bench.wait_for("the rig", lambda: "listening" in rig.output())
        bench.wait_for("the session", lambda: "Communication with the board restored" in self.shell("softgrip events"))
        time.sleep(1)  # a user needs at least this time to type the next command
        self.assertEqual(self.state(), "faulted", "a new connection must not clear the fault")
        self.shell("softgrip acknowledge")
        self.wait_for_state("idle")

    def test_the_diagnosis_commands_of_the_tutorial_work(self):
        began = time.monotonic()
        self.shell(self.desk, timeout_s=170)
        print(f"identified and diagnosed in {time.monotonic() - began:.0f} s")
        identified = json.loads((self.folder / "identified/identify.json").read_text())
        self.assertLess(identified["rmse_percent_of_span"]["tp1"], 1, "it fits well")
        self.assertTrue(any("inverse response" in warning for warning in identified["warnings"]), identified["warnings"])
        diagnosis = json.loads((self.folder / "diagnosis/diagnosis.json").read_text())
        self.assertEqual({cause["id"] for cause in diagnosis["causes"]}, {"transport_delay", "valve_lag"})
        rig = self.folder / "config/rig_tcp.yaml"
        rig.write_text(rig.read_text().replace("model: models/bench_twin.yaml", "model: ../diagnosis/model.yaml"))
        self.softgrip("check", rig)
        self.check_on_paper(self.folder / "diagnosis/report.html")

    def check_on_paper(self, page):
        """Checks the report that the command prints. The demo shows the same report."""
        text = page.read_text(encoding="utf-8")
        self.assertLess(len(text.encode()), 1_500_000)
        sheets = printing.sheets(page, self.folder)
        self.assertLessEqual(printing.before_appendix(sheets), 4)
        verdict = html.unescape(re.search(r'<p class="verdict \w+">(.*?)</p>', text)[1])
        first = " ".join(sheets[0].split())
        self.assertIn(verdict, first)
        self.assertIn("Figure 1.", first)
        captions = re.findall(r"<figcaption><b>(Figure \d+\.)</b>", text)
        self.assertGreater(len(captions), 5)
        self.assertEqual([caption for caption in captions if sum(caption in sheet for sheet in sheets) != 1], [])


MODULE = bench.BUILD / "python"
LONGEST_S = 60  # longest permitted processor time of a notebook [s]


@unittest.skipUnless(list(MODULE.glob("softgrip/_core.*.so")), "the build has no Python module: pybind11 was missing")
class Notebooks(bench.BenchTest):
    """Runs the cells of each docs/tutorial/*.ipynb, one after the other, in one Python process. A Jupyter
    kernel does the same for cells without magic commands, but it would need fifty packages."""

    def printed(self, name):
        """Runs the cells of the notebook in the folder of the test. Returns what they print."""
        notebook = json.loads((bench.SOURCE / "docs/tutorial" / name).read_text(encoding="utf-8"))
        self.assertEqual(notebook["nbformat"], 4)
        cells = ["".join(cell["source"]) for cell in notebook["cells"] if cell["cell_type"] == "code"]
        self.assertFalse(any(cell["outputs"] for cell in notebook["cells"] if cell["cell_type"] == "code"),
                         "the notebook must be stored without outputs")
        self.assertNotIn("subprocess", "".join(cells))
        program = self.write("cells.py", "\n\n".join(cells))
        before_s = self.computed_s()
        done = subprocess.run([sys.executable, program], cwd=self.folder, text=True, capture_output=True,
                              timeout=170 * bench.PATIENCE, env={**os.environ, "MPLBACKEND": "Agg", "PYTHONPATH": str(MODULE)})
        self.assertEqual(done.returncode, 0, f"{done.stdout}\n{done.stderr}")
        took_s = self.computed_s() - before_s
        print(f"{name}: {took_s:.0f} s")
        self.assertLess(took_s, LONGEST_S)
        return done.stdout

    @staticmethod
    def computed_s():
        """Returns the processor time [s] of all child processes that have ended. Unlike the elapsed time, the
        processor time does not depend on other tests."""
        used = resource.getrusage(resource.RUSAGE_CHILDREN)
        return used.ru_utime + used.ru_stime

    def test_the_notebook_for_a_foreign_log_writes_a_figure(self):
        printed = self.printed("foreign-log.ipynb")
        difference_mm = float(re.search(r"(\S+) mm is the largest difference", printed).group(1))
        self.assertLess(difference_mm, 1e-9)
        self.assertIn("cause_found ['transport_delay', 'valve_lag']", printed)
        rmse = {name: float(value) for name, value in re.findall(r"RMSE (\w+): (\S+) mm", printed)}
        self.assertLess(rmse["extended"], 0.5 * rmse["refitted"])
        self.assertIn("error [mm]", (self.folder / "figure.svg").read_text())
        self.assertIn("<html", (self.folder / "report.html").read_text())

    def test_the_notebook_for_a_measured_log_writes_a_figure(self):
        shutil.copytree(bench.SOURCE / "bench/foreign/data/piezo", self.folder / "bench/foreign/data/piezo")
        printed = self.printed("measured-log.ipynb")
        percent = {name: float(value) for name, value in re.findall(r"(\w+) structure: RMSE .* \((\S+) % of the span", printed)}
        self.assertLess(percent["selected"], 0.5 * percent["published"])
        caption = (self.folder / "figure.txt").read_text(encoding="utf-8").strip()
        for word in ("MIT licence", self.softgrip("--version").stdout.strip()):
            self.assertIn(word, caption)
        picture = (self.folder / "figure.svg").read_text(encoding="utf-8")
        for word in (caption, "voltage [V]", "displacement [µm]", "time [s]", "error of the prediction [µm]"):
            self.assertIn(word, picture)
        self.assertNotIn("<image", picture)
        self.assertTrue((self.folder / "figure.pdf").read_bytes().startswith(b"%PDF"))


if __name__ == "__main__":
    unittest.main()
