"""Tests the figures in reports and the figures of softgrip plot."""

import csv
import pathlib
import re
import shutil
import subprocess
import tempfile
import unittest

import bench

MODEL = "config/models/bench_twin.yaml"
GIVEN = "config/models/zhang2025.yaml"
MOST_BYTES = 1_500_000


class Figures(unittest.TestCase):
    def setUp(self):
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix="softgrip_figures_"))
        self.addCleanup(shutil.rmtree, self.folder)

    def softgrip(self, *arguments, expect=0):
        done = subprocess.run([str(bench.SOFTGRIP), *map(str, arguments)], cwd=bench.SOURCE, capture_output=True,
                              text=True, timeout=150 * bench.PATIENCE)
        self.assertEqual(done.returncode, expect, done.stdout + done.stderr)
        return done

    def log(self, rate_hz, signal="tp1"):
        log = self.folder / f"{signal}_{rate_hz}.csv"
        self.softgrip("simulate", "--model", MODEL, "--input", signal, "--rate-hz", rate_hz, "--noise-mm", 0.05,
                      "--out", log)
        return log

    def test_a_report_of_600000_rows_is_small_and_each_figure_is_also_a_file(self):
        out = self.folder / "out"
        self.softgrip("validate", "--model", GIVEN, "--data", self.log(12000), "--out", out)
        page = (out / "report.html").read_text()
        self.assertLess(len(page.encode()), MOST_BYTES)
        self.assertIn("prefers-color-scheme:dark", page)

        figures = self.folder / "figures"
        self.softgrip("validate", "--model", GIVEN, "--data", self.log(100), "--out", out, "--figures", figures)
        page = (out / "report.html").read_text()
        captions = re.findall(r"<figcaption><b>Figure (\d+)\.</b> (\w[^<]+)", page)
        self.assertEqual([int(number) for number, _ in captions], list(range(1, len(captions) + 1)))
        self.assertGreater(len(captions), 1)
        stems = re.findall(r'download="(figure-\d+-[^"]+)\.svg"', page)
        self.assertEqual(len(stems), len(captions), "each figure of the page is also a file")
        self.assertEqual({p.name for p in figures.iterdir()},
                         {stem + ending for stem in stems for ending in (".svg", ".pdf", ".csv")})
        for stem in stems:
            pdf = (figures / f"{stem}.pdf").read_bytes()
            self.assertTrue(pdf.startswith(b"%PDF-"))
            self.assertEqual(len(re.findall(rb"/Type /Page\b", pdf)), 1)
        with (figures / f"{stems[0]}.csv").open() as file:
            rows = list(csv.DictReader(file))
        self.assertEqual(len(rows), 5001, "every sample of the log")
        self.assertIn("time [s]", rows[0])

    def test_plot_writes_the_format_of_the_file_name_or_rejects_the_call(self):
        first, second = self.log(100), self.log(100, "steps")
        for ending, begins in ((".svg", b"<svg"), (".pdf", b"%PDF-"), (".png", b"\x89PNG"), (".html", b"<!DOCTYPE")):
            picture = self.folder / f"picture{ending}"
            self.softgrip("plot", first, "--out", picture)
            self.assertTrue(picture.read_bytes().startswith(begins), ending)
        for name in ("x.bmp", "x"):
            refused = self.softgrip("plot", first, "--out", self.folder / name, expect=2)
            self.assertIn("svg, pdf, png or html", refused.stderr)
            self.assertFalse((self.folder / name).exists())
        self.assertTrue(self.softgrip("plot", first, "--out", "-").stdout.startswith("<svg"))
        self.softgrip("plot", first, "--channel", "left", "--out", self.folder / "x.svg", expect=2)
        beyond = self.softgrip("plot", first, "--from", 1000, "--out", self.folder / "x.svg", expect=2)
        self.assertIn("has no samples from 1000 s on: the recording lasts from 0 to", beyond.stderr)
        before = self.softgrip("plot", first, "--to", -1, "--out", self.folder / "x.svg", expect=2)
        self.assertIn("has no samples up to -1 s: the recording lasts from 0 to", before.stderr)

        over = self.softgrip("plot", first, second, "--from", 10, "--to", 12, "--out", "-").stdout
        self.assertIn(">measured, steps_100.csv<", over)
        self.assertRegex(over, r">10(\.0)?</text>.*>12(\.0)?</text>")
        self.assertNotIn(">14", over)
        beside = self.softgrip("plot", first, second, "--beside", "--out", "-").stdout
        width = lambda svg: int(re.search(r'width="(\d+)"', svg)[1])
        self.assertGreater(width(beside), width(over))


if __name__ == "__main__":
    unittest.main()
