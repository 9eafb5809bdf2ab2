#!/usr/bin/env python3
"""Measures the duration of a vent under attack by hostile clients: vent_times.py [--times 20] [--page] [--only WORD]

Repeats every test of VentsUnderAttack (tests/system/test_vents_under_attack.py) that vents during an attack, each time
with its own rig and daemon. Prints the longest and the median time from the line of the client until the outputs are
below 1 kPa. --page writes the table into docs/results/vents-under-attack.md. Needs a release build (SOFTGRIP_BUILD).
The test with a full disk needs the right to mount one.
"""

import argparse
import contextlib
import os
import pathlib
import re
import statistics
import sys
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[1]
PAGE = ROOT / "docs/results/vents-under-attack.md"
MARKS = ("<!-- vents: written by scripts/vent_times.py --page -->\n", "<!-- /vents -->")
sys.path.insert(0, str(ROOT / "tests/system"))
import test_vents_under_attack  # noqa: E402

ATTACKS = (
    ("test_a_vent_takes_less_than_0_5_s_with_1000_silent_connections", "1,000 silent connections"),
    ("test_a_vent_takes_less_than_0_5_s_during_floods_of_acknowledgements", "four clients that send `acknowledge` as fast as they can"),
    ("test_a_vent_takes_less_than_0_5_s_during_pipelined_event_requests", "a client that sends many `events` requests without waiting for the replies, and that reads or does not read the replies"),
    ("test_a_vent_takes_less_than_0_5_s_with_stopped_clients", "sixteen client processes that are stopped by SIGSTOP: in the middle of a line, with unread replies, with unread events, or in `softgrip watch`"),
    ("test_a_vent_takes_less_than_0_5_s_on_a_full_disk", "a disk that becomes full during a recording, and that remains full when the next recording begins"),
    ("test_a_vent_takes_less_than_0_5_s_without_free_file_descriptors", "no free file descriptor, and twenty connections"),
    ("test_a_vent_takes_less_than_0_5_s_with_a_pipe_among_the_sequences", "a start request for a sequence file that is a pipe"),
    ("test_a_vent_takes_less_than_0_5_s_while_a_disk_does_not_respond", "a start request for a sequence file that cannot be opened"),
)


def repeated(name, times):
    """Returns the duration of every vent [s], and the number of runs in which a test failed."""
    waited, wrong = [], 0
    for _ in range(times):
        test_vents_under_attack.VentsUnderAttack.waited_s.clear()
        with open(os.devnull, "w") as quiet, contextlib.redirect_stdout(quiet):
            outcome = unittest.TextTestRunner(quiet, verbosity=0).run(test_vents_under_attack.VentsUnderAttack(name))
        for _, text in outcome.failures + outcome.errors:
            print(f"{name}:\n{text}", file=sys.stderr)
        for _, reason in outcome.skipped:
            sys.exit(f"{name}: {reason}")
        wrong += not outcome.wasSuccessful()
        waited += test_vents_under_attack.VentsUnderAttack.waited_s.get(name, [])
    return waited, wrong


def table(times, only):
    lines = ["| attack or condition | number of vents | longest time | median time | failed runs |", "|---|---|---|---|---|"]
    worst = 0.0
    for name, words in ATTACKS:
        if only and only not in name:
            continue
        waited, wrong = repeated(name, times)
        if not waited:
            sys.exit(f"{name}: the test reported no vent")
        worst = max(worst, *waited)
        lines.append(f"| {words} | {len(waited)} | {max(waited) * 1000:.0f} ms | {statistics.median(waited) * 1000:.0f} ms | {wrong} |")
        print(lines[-1], flush=True)
    return "\n".join(lines) + f"\n\nThe longest time of all vents is **{worst * 1000:.0f} ms**.\n"


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--times", type=int, default=20, help="how often each attack is repeated")
    parser.add_argument("--page", action="store_true", help="write the table into docs/results/vents-under-attack.md")
    parser.add_argument("--only", default="", help="run only the attacks whose test name contains this text")
    arguments = parser.parse_args()
    text = table(arguments.times, arguments.only)
    print(text)
    if arguments.page:
        begin, end = map(re.escape, MARKS)
        page, count = re.subn(f"({begin}).*({end})", lambda m: m[1] + text + m[2], PAGE.read_text(), flags=re.DOTALL)
        if count != 1:
            sys.exit(f"{PAGE} does not contain the two marks between which the table belongs")
        PAGE.write_text(page)


if __name__ == "__main__":
    main()
