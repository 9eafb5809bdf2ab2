#!/usr/bin/python3
"""Draws the first figures of the demo's diagnosis as one picture, in both colour schemes.

    scripts/report_picture.py [--build build/release] [--out docs/pictures/diagnosis.svg]

Simulates the logs of the demo and diagnoses the published model on these logs, which takes one or two minutes. The
picture shows verdict, error budget, forest plot, block diagram and errors in the order of the report.
"""
import argparse
import html
import pathlib
import re
import subprocess
import tempfile

ROOT = pathlib.Path(__file__).resolve().parent.parent
SHOWN = 4
MARGIN_PX, TITLE_PX, GAP_PX, LINE_CHARACTERS = 12, 22, 14, 96


def softgrip(build, *arguments):
    return subprocess.run([str(build / "tools/softgrip"), *map(str, arguments)], cwd=ROOT, check=True, text=True,
                          capture_output=True).stdout


def diagnosed(build, folder):
    """Diagnoses the logs of the demo. Returns (verdict, SVG texts of the first figures)."""
    logs = []
    for signal in ("tp1", "steps", "sp2"):
        logs.append(folder / f"{signal}.csv")
        softgrip(build, "simulate", "--model", "config/models/bench_twin.yaml", "--input", signal, "--out", logs[-1],
                 "--noise-mm", "0.05", "--seed", "3", "--rate-hz", "100")
    said = softgrip(build, "diagnose", "--model", "config/models/zhang2025.yaml", "--data", *logs, "--out", folder / "out",
                    "--figures", folder / "figures")
    svgs = sorted((folder / "figures").glob("*.svg"), key=lambda p: int(re.match(r"figure-(\d+)", p.name)[1]))
    return said.split("\n", 1)[0], [p.read_text() for p in svgs[:SHOWN]]


def wrapped(text):
    lines = [""]
    for word in text.split():
        if len(lines[-1]) + len(word) >= LINE_CHARACTERS:
            lines.append("")
        lines[-1] += (" " if lines[-1] else "") + word
    return lines


def picture(verdict, svgs):
    style = re.search(r"<style>.*?</style>", svgs[0], re.S)[0]
    parts, y = [], MARGIN_PX + TITLE_PX
    for line in wrapped(verdict):
        parts.append(f'<text x="{MARGIN_PX + 8}" y="{y}" class="f-text" fill="#20272c" font-size="15">{html.escape(line)}</text>')
        y += TITLE_PX
    width = 0
    for svg in svgs:
        w, h = (int(re.search(rf'\b{side}="(\d+)"', svg)[1]) for side in ("width", "height"))
        inside = re.sub(r"<style>.*?</style>", "", svg.strip(), flags=re.S)
        parts.append(inside.replace("<svg ", f'<svg x="{MARGIN_PX}" y="{y}" ', 1))
        y += h + GAP_PX
        width = max(width, w)
    size = f"{width + 2 * MARGIN_PX} {y}"
    return (f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {size}" width="{width + 2 * MARGIN_PX}" height="{y}" '
            f'role="img" font-family="system-ui,sans-serif">{style}<title>{html.escape(verdict)}</title>'
            f'<rect width="100%" height="100%" rx="6" class="f-paper" fill="#ffffff"/>{"".join(parts)}</svg>\n')


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--build", type=pathlib.Path, default=ROOT / "build/release")
    parser.add_argument("--out", type=pathlib.Path, default=ROOT / "docs/pictures/diagnosis.svg")
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        options.out.write_text(picture(*diagnosed(options.build.resolve(), pathlib.Path(folder))))
    print(options.out)


if __name__ == "__main__":
    main()
