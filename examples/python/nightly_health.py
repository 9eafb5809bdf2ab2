"""Checks the health of all fingers; run it once per night: nightly_health.py RECORDINGS BASELINE OUT. Exit code 1: an
alarm is active, or an error occurred.

The program stores the indicators of each recording in the folder OUT, so that it reads each recording only once. It
also writes a page per finger into this folder.
"""

import pathlib
import sys

import softgrip


def main(recordings: str, baseline: str, out: str) -> int:
    folder = pathlib.Path(out)
    folder.mkdir(parents=True, exist_ok=True)
    notes = folder / "notes.yaml"  # records such as {date: 2026-11-03, finger: left, action: finger replaced}
    health = softgrip.health(recordings, baseline, notes=notes if notes.exists() else None,
                             scores=folder / "health-scores.jsonl")
    for finger in health.fingers:
        print(f"{finger.finger}: {finger.sentence}")
        for suspect in finger.suspects:
            print(f"  {suspect.id}: {suspect.next_steps[0]}")
        (folder / f"health-{finger.finger}.html").write_text(finger.html, encoding="utf-8")
    for text in health.warnings:
        print(text)
    for name, reason in health.skipped:
        print(f"{name} was not used: {reason}")
    return 1 if health.alarm else 0


if __name__ == "__main__":
    try:
        sys.exit(main(*sys.argv[1:]))
    except softgrip.SoftgripError as error:
        sys.exit(f"nightly_health: {error}")
