"""Prints a page with chromium and reads the printed text with poppler."""

import re
import subprocess

import browser


def sheets(page, folder):
    """Returns the text of each printed page."""
    paper = folder / "printed.pdf"
    subprocess.run(["chromium", *browser.QUIET, f"--user-data-dir={folder / 'chromium'}", "--no-pdf-header-footer",
                    f"--print-to-pdf={paper}", page.resolve().as_uri()], check=True, capture_output=True, timeout=120)
    text = subprocess.run(["pdftotext", "-layout", paper, "-"], check=True, capture_output=True, text=True, timeout=60).stdout
    found = text.split("\f")[:-1]
    told = subprocess.run(["pdfinfo", paper], check=True, capture_output=True, text=True, timeout=60).stdout
    assert re.search(rf"^Pages: +{len(found)}$", told, re.MULTILINE) and "(A4)" in told, told
    return found


def before_appendix(printed):
    """Returns the number of printed pages before the appendix."""
    return next(i for i, sheet in enumerate(printed) if sheet.lstrip().startswith("Appendix"))
