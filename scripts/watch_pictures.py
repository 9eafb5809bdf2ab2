#!/usr/bin/python3
"""Draws two recordings of `softgrip watch` as pictures, at 80 and 60 columns, from the output on a real terminal.

    scripts/watch_pictures.py [--build build/release] [--out docs/pictures]

The emulator replaces the board. The recording with 80 columns shows a part that is held. In the recording with 60
columns, a sensor is disconnected and later reconnected. The text on the terminal is written as SVG with the colours
of the terminal.
"""
import argparse
import html
import os
import pathlib
import sys
import time
import unittest

ROOT = pathlib.Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT / "tests/system"))

CELL_PX = (8.4, 18)
MARGIN_PX = 12
PAPER, INK, FAINT = "#14191f", "#d5dae0", "#8792a0"
COLOURS = {"default": INK, "green": "#57c785", "brown": "#e0af4f", "red": "#ff6b61", "black": FAINT}


def runs(row, columns):
    """Joins neighbouring cells with the same style to groups. Returns (column, text, colour, bold) of each group."""
    found = []
    for column in range(columns):
        cell = row[column]
        look = (COLOURS.get(cell.fg, INK), cell.bold)
        if found and found[-1][2:] == look:
            found[-1][1] += cell.data
        else:
            found.append([column, cell.data, *look])
    return [run for run in found if run[1].strip()]


def svg(screen, title):
    width = 2 * MARGIN_PX + screen.columns * CELL_PX[0]
    height = 2 * MARGIN_PX + screen.lines * CELL_PX[1]
    lines = [f'<svg xmlns="http://www.w3.org/2000/svg" width="{width:g}" height="{height:g}" '
             f'viewBox="0 0 {width:g} {height:g}" role="img">', f"<title>{html.escape(title)}</title>",
             f'<rect width="100%" height="100%" rx="6" fill="{PAPER}"/>',
             '<g font-family="DejaVu Sans Mono, Menlo, Consolas, monospace" font-size="14" xml:space="preserve">']
    for number in range(screen.lines):
        y = MARGIN_PX + (number + 0.75) * CELL_PX[1]
        for column, text, colour, bold in runs(screen.buffer[number], screen.columns):
            kept = text.rstrip()
            x = MARGIN_PX + column * CELL_PX[0]
            # The SVG states the width of every group of cells, so that a different font does not shift the columns.
            lines.append(f'<text x="{x:g}" y="{y:g}" fill="{colour}" textLength="{len(kept) * CELL_PX[0]:g}" '
                         f'lengthAdjust="spacingAndGlyphs"{" font-weight=" + chr(34) + "bold" + chr(34) if bold else ""}>'
                         f"{html.escape(kept)}</text>")
    return "\n".join([*lines, "</g>", "</svg>", ""])


def record(out):
    import bench
    import terminal

    class Recording(bench.BenchTest):
        def watch(self, columns, rows):
            program = [bench.SOFTGRIP, "watch", "--socket", self.softgripd.socket_path]
            watched = terminal.Terminal(program, self.folder, columns, rows)
            self.addCleanup(watched.close)
            return watched

        def write_picture(self, watched, name, title):
            watched.read(0.3)
            (out / name).write_text(svg(watched.screen, title))
            print(out / name)

        def runTest(self):
            self.emulated = self.emulator("--object", "stone", "--faults", self.write("faults.yaml", (
                "faults:\n  - {name: blind, kind: sensor_out_of_range, channel: right}\n")))
            rig = self.rig(self.emulated.port, ((r"directory: \S+/runs", "directory: /tmp/softgrip-runs"),))
            self.softgripd = self.idle_daemon(rig)
            wide, narrow = self.watch(80, 24), self.watch(60, 30)
            self.softgripd.start("hand_over")
            bench.wait_for("the hold", lambda: self.softgripd.results() == ["HOLDING", "HOLDING"])
            end = time.monotonic() + 4
            while time.monotonic() < end:
                wide.read(0.1)
                narrow.read(0.1)
            self.write_picture(wide, "watch-80.svg", "softgrip watch at 80 columns: both fingers hold a part")
            self.emulated.ask("fault blind")
            narrow.wait_for("fault F202 of right")
            self.emulated.ask("clear blind")
            narrow.wait_for("The cause is gone")
            self.write_picture(narrow, "watch-60.svg",
                               "softgrip watch at 60 columns: after a sensor failed during a hold, the fingers remain pressurised")

    return unittest.TextTestRunner(verbosity=0).run(Recording()).wasSuccessful()


def main():
    arguments = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    arguments.add_argument("--build", type=pathlib.Path, default=ROOT / "build/release")
    arguments.add_argument("--out", type=pathlib.Path, default=ROOT / "docs/pictures")
    given = arguments.parse_args()
    os.environ["SOFTGRIP_BUILD"] = str(given.build.resolve())
    given.out.mkdir(parents=True, exist_ok=True)
    return 0 if record(given.out) else 1


if __name__ == "__main__":
    sys.exit(main())
