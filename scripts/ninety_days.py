#!/usr/bin/python3
"""Ninety days of a rig at work, in virtual time: what `softgrip health` notices of what happens to its fingers.

    scripts/ninety_days.py [--build build/release] [--healthy 3] [--seed 1] [--keep DIR] [--page PAGE.md]

Two fingers grip four times a day, three times with one recipe and once with another. In every life the temperature of the
hall goes with the hour and the weather (which stays for days) and the gain of the fingers with it, parts stand a little
elsewhere each time, and the fingers wear a little. In the eventful life a leak begins and grows, a sensor is knocked out
of place, a finger is replaced, and another one softens; what is mended is noted. Every recording is made by
`softgrip run`. The exit code is 1 where something that happened was not noticed.
"""
import argparse
import concurrent.futures
import dataclasses
import datetime
import json
import math
import os
import pathlib
import random
import subprocess
import sys
import tempfile
import time

ROOT = pathlib.Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT / "tests/system"))

import working_life  # noqa: E402

FIRST = datetime.datetime(2026, 3, 1)
DAYS = 90
HOURS = (7, 10, 13, 16)
SEQUENCES = {7: "pick_stone", 10: "pick_stone", 13: "pick_screw", 16: "pick_stone"}
FINGERS = ("left", "right")

GAIN_PER_C = 0.002
WEATHER_C, WEATHER_STAYS, DAY_C = 2.0, 0.7, 3.0
PART_MM = 0.1
WEAR_PER_DAY = -2e-5
LEAK_PER_DAY, LEAK_AT_MOST = 0.004, 0.05
KNOCKED_MM = 0.6
NEW_FINGER = 1.04
SOFTENING_PER_DAY = -0.003


@dataclasses.dataclass(frozen=True)
class Event:
    what: str
    finger: str
    day: int
    mended: int  # day; DAYS: not in these ninety
    note: str
    causes: tuple  # any of them is right


EVENTS = (
    Event("a leak begins, 0.4 % of the pressure more each day up to 5 %", "left", 30, 45, "tube replaced", ("leak",)),
    Event(f"the sensor is knocked, {KNOCKED_MM} mm", "right", 40, 50, "sensor put back", ("sensor_drift",)),
    Event("the finger softens by 0.3 % a day", "right", 68, DAYS, "", ("ageing", "thermal_gain", "stress_softening")),
)
NOTES = [(45, "left", "tube replaced"), (50, "right", "sensor put back"), (60, "left", "finger replaced")]


def text_of(day, hour=0):
    return (FIRST + datetime.timedelta(days=day, hours=hour)).strftime("%Y-%m-%dT%H:%M:%SZ")


def weather(rng):
    values, now = [], rng.gauss(0, WEATHER_C)
    for _ in range(DAYS):
        now = WEATHER_STAYS * now + math.sqrt(1 - WEATHER_STAYS**2) * rng.gauss(0, WEATHER_C)
        values.append(now)
    return values


def finger_of(name, day, hour, warmer_c, eventful):
    gain = (1 + GAIN_PER_C * (warmer_c + DAY_C * math.sin((hour - 9) / 24 * 2 * math.pi))) * (1 + WEAR_PER_DAY * day)
    leak, zero_mm = 0, 0
    if eventful:
        for event in EVENTS:
            since = day - event.day
            if event.finger != name or since < 0 or day >= event.mended:
                continue
            if "leak" in event.causes:
                leak = min(LEAK_AT_MOST, LEAK_PER_DAY * (since + 1))
            elif "sensor_drift" in event.causes:
                zero_mm = KNOCKED_MM
            else:
                gain *= 1 + SOFTENING_PER_DAY * (since + 1)
        if name == "left" and day >= 60:
            gain *= NEW_FINGER
    return working_life.Finger(gain=gain, leak=leak, zero_mm=zero_mm)


def live(softgrip, folder, seed, eventful):
    """Makes the recordings of a life."""
    rng = random.Random(seed)
    rig = working_life.Rig(softgrip, folder)
    if not (folder / "baseline/baseline.json").exists():
        rig.baseline()
    for day, warmer_c in enumerate(weather(rng)):
        for hour in HOURS:
            grip = working_life.Grip(
                text_of(day, hour), rng.randrange(1 << 30),
                {name: finger_of(name, day, hour, warmer_c, eventful) for name in FINGERS},
                SEQUENCES[hour], 12 + rng.gauss(0, PART_MM))
            if not rig.has(grip):
                rig.play(grip)
    return rig


def health(softgrip, folder, notes, until=DAYS):
    """What is said with all recordings before a day. Each is scored once, by the call that sees all of them."""
    out = folder / f"health-{until}"
    out.mkdir(exist_ok=True)
    noted = "".join(f"  - {{date: {text_of(day)}, finger: {finger}, mended: {what}}}\n" for day, finger, what in notes
                    if day < until)
    (out / "notes.yaml").write_text(f"notes:\n{noted}" if noted else "notes: []\n")
    runs = sorted(path for path in (folder / "recordings").iterdir() if path.name < text_of(until).replace(":", "-"))
    if until < DAYS:
        lines = (folder / f"health-{DAYS}/health-scores.jsonl").read_text().splitlines(keepends=True)
        (out / "health-scores.jsonl").write_text(
            "".join(line for line in lines if json.loads(line)["started_at"] < text_of(until)))
    done = subprocess.run([str(softgrip), "health", *map(str, runs), "--baseline", str(folder / "baseline"), "--out", str(out),
                           "--json"], capture_output=True, text=True)
    if done.returncode not in (0, 6):
        raise SystemExit(done.stderr)
    return {finger["finger"]: finger for finger in json.loads(done.stdout)["fingers"]}


def day_of(label):
    return (datetime.datetime.strptime(label, "%Y-%m-%d") - FIRST).days


def judged_event(softgrip, folder, event):
    """What is noticed of an event before it is mended: day, numbers, suspect."""
    said = health(softgrip, folder, NOTES, event.mended)[event.finger]
    alarms = [alarm for alarm in said["alarms"] if alarm["stands"] and day_of(alarm["noticed"]) >= event.day]
    if not alarms:
        return None
    first = min(alarms, key=lambda alarm: day_of(alarm["noticed"]))
    noticed = day_of(first["noticed"])
    soon = health(softgrip, folder, NOTES, min(event.mended, noticed + 1))[event.finger]
    return {"day": noticed, "grips": (noticed - event.day + 1) * len(HOURS), "numbers": [a["number"] for a in alarms],
            "at_once": [one["id"] for one in soon["suspects"]], "suspects": [one["id"] for one in said["suspects"]]}


def false_alarms(said, eventful):
    """Alarms of a number that nothing explains, with their day."""
    found = []
    for finger in said.values():
        for alarm in finger["alarms"]:
            day = day_of(alarm["noticed"])
            if not any(event.finger == finger["finger"] and event.day <= day < event.mended for event in EVENTS if eventful):
                found.append(f"{finger['finger']} {alarm['number']} on day {day}, {alarm['change']:+.3g}")
    return found


def page(args, seen, wrong, healthy, wall_s):
    rows = "".join(
        f"| {event.what} | {event.finger} | {event.day} | " + (
            f"{one['day']} | {one['grips']} | {', '.join(f'`{number}`' for number in one['numbers'])} | "
            f"{', '.join(one['at_once']) or '-'} | {', '.join(one['suspects']) or '-'} |\n" if one else "not | - | - | - | - |\n")
        for event, one in zip(EVENTS, seen))
    took = "" if args.keep else f" and what is said of them, {wall_s / 60:.1f} minutes on {os.cpu_count()} cores"
    fingers = {(life, found.split()[0]) for life, all_found in enumerate(healthy) for found in all_found}
    listed = "".join(f"- life {number + 1}: {'; '.join(found)}\n" for number, found in enumerate(healthy) if found)
    return f"""# Ninety days of a rig at work

Made by `scripts/ninety_days.py --healthy {args.healthy} --seed {args.seed} --page docs/reference/ninety-days.md`, with
{len(HOURS)} grips a day of two fingers in virtual time: {(args.healthy + 1) * DAYS * len(HOURS)} recordings of `softgrip
run`{took}. What becomes of a finger goes into its plant; `softgrip health` sees the recordings alone.

In every life: weather of {WEATHER_C:g} °C (standard deviation, correlated by {WEATHER_STAYS:g} from day to day), {DAY_C:g} °C within the day, a
gain of {100 * GAIN_PER_C:g} % per °C, parts that stand {PART_MM:g} mm elsewhere (standard deviation), wear of {-100 * WEAR_PER_DAY * DAYS:.1g} % in ninety
days. Temperature is not recorded.

## What was noticed

| what happened | finger | on day | noticed on day | after grips | numbers in alarm before it was mended | suspected that night | suspected before it was mended |
|---|---|---|---|---|---|---|---|
{rows}
On day 60 the left finger was replaced by one that is {100 * (NEW_FINGER - 1):.0f} % softer, which was noted; its charts began anew.
Alarms in the eventful life that nothing explains: {'; '.join(wrong) or 'none'}.

## Healthy days

Lives of {DAYS} days in which nothing happens but weather and wear, two fingers each, nine charts a finger. Stated for days
that are independent of each other is one false alarm in 3650 points of a finger. Of {2 * args.healthy} fingers {len(fingers)} alarmed:

{listed or "- none" + chr(10)}
An alarm that stands hides further ones of the same number. Weather moves both fingers of a rig alike, which `softgrip
health` tells (`shared`); it is taken for a change where the first days were calmer than the rest. What these figures do not say: simulated fingers are all of one kind, and the weather is the only thing that stays for days.
"""


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--build", type=pathlib.Path, default=ROOT / "build/release")
    parser.add_argument("--healthy", type=int, default=3)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--keep", type=pathlib.Path, help="keep the recordings here, and go on with those that are there")
    parser.add_argument("--page", type=pathlib.Path)
    args = parser.parse_args()
    softgrip = (args.build / "tools/softgrip").resolve()
    began = time.monotonic()
    with tempfile.TemporaryDirectory(prefix="softgrip-ninety-") as temporary:
        folder = args.keep or pathlib.Path(temporary)
        lives = [(folder / "eventful", args.seed, True)]
        lives += [(folder / f"healthy-{n}", args.seed + 1 + n, False) for n in range(args.healthy)]
        with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
            list(pool.map(lambda life: live(softgrip, *life), lives))
        wrong = false_alarms(health(softgrip, folder / "eventful", NOTES), True)
        seen = [judged_event(softgrip, folder / "eventful", event) for event in EVENTS]
        healthy = [false_alarms(health(softgrip, path, []), False) for path, _, eventful in lives if not eventful]
    text = page(args, seen, wrong, healthy, time.monotonic() - began)
    if args.page:
        args.page.write_text(text)
    print(text)
    return 0 if all(one and set(event.causes) & set(one["suspects"]) for event, one in zip(EVENTS, seen)) else 1


if __name__ == "__main__":
    sys.exit(main())
