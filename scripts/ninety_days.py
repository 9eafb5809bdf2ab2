#!/usr/bin/python3
"""Simulates 90 days of work of a rig and checks what `softgrip health` detects.

    scripts/ninety_days.py [--build build/release] [--healthy 6] [--seed 1] [--keep DIR] [--page PAGE.md]

Two fingers grip four times a day, three times with one recipe and once with another. Each simulation is called a
life. In every life, the temperature changes the gain of the fingers. The temperature varies with the hour and with
the weather, which persists for days. The positions of the parts vary slightly, and the fingers wear a little. In the
life with events, a leak begins and grows, a sensor is displaced, a finger is replaced, the gain of another finger
decreases, and a common supply line begins to leak. Each repair has a maintenance record. `softgrip run` makes every
recording on a rig with a thermometer. The recordings are judged four times: with and without the temperature, for
both fingers together and for each alone. The exit code is 1 if an event was not detected.
"""
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

import results_page  # noqa: E402
import working_life  # noqa: E402

FIRST = datetime.datetime(2026, 3, 1)
DAYS = 90
HOURS = (7, 10, 13, 16)
SEQUENCES = {7: "pick_stone", 10: "pick_stone", 13: "pick_screw", 16: "pick_stone"}
FINGERS = ("left", "right")
BOTH = "both"

GAIN_PER_C = {"left": 0.002, "right": 0.0025}
HALL_C, WEATHER_C, WEATHER_STAYS, DAY_C = 20.0, 2.0, 0.7, 3.0
PART_MM = 0.1
WEAR_PER_DAY = -2e-5
LEAK_PER_DAY, LEAK_AT_MOST = 0.004, 0.05
COMMON_LEAK = 0.02
KNOCKED_MM = 0.6
NEW_FINGER = 1.04
SOFTENING_PER_DAY = -0.003


@dataclasses.dataclass(frozen=True)
class Event:
    what: str
    finger: str
    day: int
    mended: int  # day of the repair; DAYS if there is no repair within the 90 days
    # Each of these causes is a correct diagnosis. For an event of both fingers, this is the indicator that must be
    # reported as shared.
    causes: tuple


EVENTS = (
    Event("a leak begins; the lost pressure increases by 0.4 % per day, up to 5 %", "left", 30, 45, ("leak",)),
    Event(f"the sensor is displaced by {KNOCKED_MM} mm", "right", 40, 50, ("sensor_drift",)),
    Event("the gain of the finger decreases by 0.3 % per day", "right", 68, DAYS, ("ageing", "thermal_gain", "stress_softening")),
    Event(f"the common air line of both fingers leaks; {100 * COMMON_LEAK:g} % of the pressure is lost", BOTH, 80, DAYS, ("pressure_loss_kpa",)),
)
NOTES = [(45, "left", "tube replaced"), (50, "right", "sensor put back"), (60, "left", "finger replaced")]


@dataclasses.dataclass(frozen=True)
class View:
    """The recordings of one life that `softgrip health` reads, with or without temperature."""
    temperature: bool
    fingers: tuple  # fingers that are judged together

    def name(self):
        return "-".join(("warm" if self.temperature else "blind",) + self.fingers)


def text_of(day, hour=0):
    return (FIRST + datetime.timedelta(days=day, hours=hour)).strftime("%Y-%m-%dT%H:%M:%SZ")


def weather(rng):
    values, now = [], rng.gauss(0, WEATHER_C)
    for _ in range(DAYS):
        now = WEATHER_STAYS * now + math.sqrt(1 - WEATHER_STAYS**2) * rng.gauss(0, WEATHER_C)
        values.append(now)
    return values


def finger_of(name, day, eventful):
    gain = 1 + WEAR_PER_DAY * day
    leak, zero_mm = 0, 0
    for event in EVENTS if eventful else ():
        since = day - event.day
        if event.finger not in (name, BOTH) or since < 0 or day >= event.mended:
            continue
        if event.finger == BOTH:
            leak = COMMON_LEAK
        elif "leak" in event.causes:
            leak = min(LEAK_AT_MOST, LEAK_PER_DAY * (since + 1))
        elif "sensor_drift" in event.causes:
            zero_mm = KNOCKED_MM
        else:
            gain *= 1 + SOFTENING_PER_DAY * (since + 1)
    if eventful and name == "left" and day >= 60:
        gain *= NEW_FINGER
    return working_life.Finger(gain=gain, leak=leak, zero_mm=zero_mm, gain_per_c=GAIN_PER_C[name])


def live(softgrip, folder, seed, eventful):
    """Simulates the recordings of a life and computes the scores of each recording once."""
    rng = random.Random(seed)
    rig = working_life.Rig(softgrip, folder)
    if not (folder / "baseline/baseline.json").exists():
        rig.baseline()
    for day, warmer_c in enumerate(weather(rng)):
        for hour in HOURS:
            temperature_c = HALL_C + warmer_c + DAY_C * math.sin((hour - 9) / 24 * 2 * math.pi)
            grip = working_life.Grip(
                text_of(day, hour), rng.randrange(1 << 30), {name: finger_of(name, day, eventful) for name in FINGERS},
                SEQUENCES[hour], 12 + rng.gauss(0, PART_MM), temperature_c, True)
            if not rig.has(grip):
                rig.play(grip)
    call(softgrip, folder, "recordings", folder / "scored")


def call(softgrip, folder, recordings, out):
    done = subprocess.run([str(softgrip), "health", str(folder / recordings), "--baseline", str(folder / "baseline"), "--out",
                           str(out), "--json"], capture_output=True, text=True)
    if done.returncode not in (0, 6):
        raise SystemExit(done.stderr)
    return json.loads(done.stdout)


def health(softgrip, folder, view, notes, until=DAYS):
    """Returns the result of softgrip health for all recordings before a day. Uses the stored scores, so that no
    recording is scored a second time."""
    out = folder / f"{view.name()}-{until}"
    out.mkdir(exist_ok=True)
    noted = "".join(f"  - {{date: {text_of(day)}, finger: {finger}, mended: {what}}}\n" for day, finger, what in notes
                    if day < until)
    (out / "notes.yaml").write_text(f"notes:\n{noted}" if noted else "notes: []\n")
    kept = []
    for line in map(json.loads, (folder / "scored/health-scores.jsonl").read_text().splitlines()):
        if line["started_at"] < text_of(until) and line["finger"] in view.fingers:
            kept.append(line if view.temperature else {key: value for key, value in line.items() if key != "temperature_c"})
    (out / "health-scores.jsonl").write_text("".join(json.dumps(line) + "\n" for line in kept))
    return call(softgrip, folder, pathlib.Path("recordings") / kept[0]["run"], out)


def finger_in(said, name):
    return next(finger for finger in said["fingers"] if finger["finger"] == name)


def day_of(label):
    return (datetime.datetime.strptime(label, "%Y-%m-%d") - FIRST).days


def grips_until(event, day):
    return (day - event.day + 1) * len(HOURS)


def judged_common(softgrip, folder, view, event):
    said = health(softgrip, folder, view, NOTES, event.mended)
    found = [one for one in said["shared_changes"] if one["active"] and one["number"] in event.causes and
             day_of(one["noticed"]) >= event.day]
    if not found:
        return None
    day = day_of(found[0]["noticed"])
    return {"day": day, "warned": day, "grips": grips_until(event, day), "numbers": said["shared"], "at_once": ["shared"],
            "suspects": ["shared"], "right": True}


def judged_event(softgrip, folder, view, event):
    """Returns the day on which an event was detected, the indicators, and the candidate fault. The detection must
    precede the repair."""
    if event.finger == BOTH:
        return judged_common(softgrip, folder, view, event)
    said = finger_in(health(softgrip, folder, view, NOTES, event.mended), event.finger)
    alarms = [alarm for alarm in said["alarms"] if alarm["active"] and day_of(alarm["noticed"]) >= event.day]
    if not alarms:
        return None
    noticed = min(day_of(alarm["noticed"]) for alarm in alarms)
    soon = finger_in(health(softgrip, folder, view, NOTES, min(event.mended, noticed + 1)), event.finger)
    suspects = [one["id"] for one in said["suspects"]]
    warned = [day_of(alarm["warned"]) for alarm in alarms if day_of(alarm["warned"]) >= event.day]
    return {"day": noticed, "warned": min(warned, default=noticed), "grips": grips_until(event, noticed),
            "numbers": [alarm["number"] for alarm in alarms],
            "at_once": [one["id"] for one in soon["suspects"]], "suspects": suspects,
            "right": bool(set(event.causes) & set(suspects))}


UNITS = {"_mm": "mm", "_s": "s", "_kpa": "kPa", "_kpa_per_s": "kPa/s"}


def change_of(found):
    """Returns the name of a changed indicator and the change with its unit."""
    ending = max((end for end in UNITS if found["number"].endswith(end)), key=len)
    return f"{found['number']} changed by {found['change']:+.3g} {UNITS[ending]}"


def false_alarms(said, eventful):
    """Returns the alarms that no event explains, each with its day."""
    found = []
    for finger in said["fingers"]:
        for alarm in finger["alarms"]:
            day = day_of(alarm["noticed"])
            if not any(event.finger in (finger["finger"], BOTH) and event.day <= day < event.mended
                       for event in EVENTS if eventful):
                found.append(f"{finger['finger']} finger: {change_of(alarm)}, alarm on day {day}")
    return found


def warnings(said):
    """Returns the warnings about the rig, which do not count as alarms."""
    told = [f"shared: {change_of(one)}, warning on day {day_of(one['noticed'])}" for one in said["shared_changes"]]
    for finger in said["fingers"]:
        told += [f"unclear: {one['number']} of the {finger['finger']} finger on day {day_of(one['noticed'])}" for one in finger["unclear"]]
        told += [f"unclear: {one['number']} of the {finger['finger']} finger from day {day_of(one['warned'])} to the alarm on day "
                 f"{day_of(one['noticed'])}" for one in finger["alarms"] if one["warned"] < one["noticed"]]
    return told


TOGETHER = {True: View(True, FINGERS), False: View(False, FINGERS)}


def judge_life(softgrip, folder, eventful):
    """Returns the results of a life for each selection of fingers, with and without temperature: false alarms,
    warnings and slopes."""
    notes = NOTES if eventful else []
    told = {}
    for temperature, together in TOGETHER.items():
        said = health(softgrip, folder, together, notes)
        slopes = [finger["numbers"]["gain_mm"].get("per_c") for finger in said["fingers"]]
        alone = [] if eventful else [found for finger in FINGERS for found in false_alarms(
            health(softgrip, folder, View(temperature, (finger,)), notes), False)]
        told[temperature] = {"false": false_alarms(said, eventful), "warnings": warnings(said), "alone": alone,
                             "slopes": [slope for slope in slopes if slope]}
    return told


def event_rows(seen):
    rows = ""
    for event, one in seen:
        rows += f"| {event.what} | {event.finger} | {event.day} | "
        rows += (f"{one['warned']} | {one['day']} | {one['grips']} | {', '.join(f'`{number}`' for number in one['numbers'])} | "
                 f"{', '.join(one['at_once']) or '-'} | {', '.join(one['suspects']) or '-'} |\n" if one else
                 "- | not | - | - | - | - |\n")
    return rows


def fingers_in(lives, temperature, key):
    return len({(life, found.split()[0]) for life, told in enumerate(lives) for found in told[temperature][key]})


def listed(lives, temperature, key):
    return "".join(f"- simulation {number + 1}: {'; '.join(told[temperature][key])}\n" for number, told in enumerate(lives)
                   if told[temperature][key]) or "- none\n"


NAMES = {True: "with the temperature", False: "without the temperature"}


def page(args, seen, eventful, healthy, wall_s):
    took = "" if args.keep else f", with their simulation in {wall_s / 60:.1f} minutes on {os.cpu_count()} cores"
    slopes = [slope for told in healthy for slope in told[True]["slopes"]]
    counts = "".join(
        f"| {NAMES[temperature]} | {fingers_in(healthy, temperature, 'false')} of {2 * args.healthy} | "
        f"{fingers_in(healthy, temperature, 'alone')} of {2 * args.healthy} | "
        f"{sum(bool(told[temperature]['warnings']) for told in healthy)} of {args.healthy} |\n" for temperature in TOGETHER)
    lists = "".join(f"Alarms if both fingers are evaluated together, {NAMES[t]}:\n\n{listed(healthy, t, 'false')}\n"
                    f"Warnings that the rig has changed, {NAMES[t]}:\n\n{listed(healthy, t, 'warnings')}\n"
                    f"Alarms if each finger is evaluated alone, {NAMES[t]}:\n\n{listed(healthy, t, 'alone')}\n" for t in TOGETHER)
    told = "".join(f"### {NAMES[t].capitalize()}\n\n| change | finger | first day of the change | day of the warning | "
                   f"day of the alarm | grips between change and alarm | indicators in "
                   f"alarm before the repair | candidate faults in the night of the alarm | candidate faults before the repair |\n"
                   f"|---|---|---|---|---|---|---|---|---|\n{event_rows(seen[t])}\n"
                   f"False alarms: {'; '.join(eventful[t]['false']) or 'none'}. Warnings that are not alarms: "
                   f"{'; '.join(eventful[t]['warnings']) or 'nothing'}.\n\n" for t in TOGETHER)
    found = sum(bool(one and one["right"]) for _, one in seen[True])
    head = results_page.head(
        "Ninety days of a rig at work",
        f"On a rig with a temperature sensor, `softgrip health` finds {found} of {len(seen[True])} simulated changes. In 90 simulated "
        f"days, it reports a false alarm for {fingers_in(healthy, True, 'false')} of {2 * args.healthy} healthy fingers.",
        results_page.version_of(args.build), f"scripts/ninety_days.py --healthy {args.healthy} --seed {args.seed} --page "
        "docs/results/ninety-days.md", f"simulated rig, virtual time, {len(HOURS)} grips a day of two fingers")
    return "\n".join(head) + f"""
`softgrip health` evaluated {(args.healthy + 1) * DAYS * len(HOURS)} recordings of `softgrip run`{took}. The changes of a finger are simulated by changes of its model. `softgrip health` reads only the recordings, so it has no information about the simulated changes.

Each simulation covers {DAYS} days of one rig with two fingers. The mean temperature of a day has a standard deviation of {WEATHER_C:g} °C, and the correlation of the temperatures of two consecutive days is {WEATHER_STAYS:g}. Within a day, the temperature varies sinusoidally with an amplitude of {DAY_C:g} °C.
The gain of the left finger changes by {100 * GAIN_PER_C["left"]:g} % per °C, and the gain of the right finger by {100 * GAIN_PER_C["right"]:g} % per °C. The standard deviation of the position of the parts is
{PART_MM:g} mm. Wear reduces the gain of the fingers by {-100 * WEAR_PER_DAY * DAYS:.1g} % in {DAYS} days. The rig has one temperature sensor with a noise of {working_life.THERMOMETER_NOISE_C:g} °C. The recordings of each simulation are evaluated twice: with and without the recorded temperatures. The evaluation without temperatures corresponds to a rig without a temperature sensor.

## Detected changes

{told}The column "day of the warning" contains the first day, from the first day of the change on, on which `softgrip health` reported that the difference between the two fingers had changed (for a change of both fingers: that the rig had changed). A report with the word `unclear` does not name the changed finger. A report with the word `shared` means that the indicator changed in the same direction for both fingers. `softgrip health` then assumes that the rig has changed. On day 60, the left finger was replaced by a finger that is {100 * (NEW_FINGER - 1):.0f} % softer. The maintenance record contains the replacement of the finger, so `softgrip health` monitored the new finger with a new reference.

## Healthy days

In {args.healthy} simulations of {DAYS} days, only the weather and the wear change the fingers. `softgrip health` monitors nine indicators of each finger. The alarm limits are set so that,
on average, a healthy finger has one false alarm in 3650 daily points, if the days are independent. The expected number of false alarms for {2 * args.healthy} fingers in {DAYS} days is therefore {2 * args.healthy * DAYS / 3650:.2f}.
The table states the number of fingers with an alarm, and the number of simulations with a reported change of the rig:

| evaluated recordings | fingers with an alarm if both fingers are evaluated together | fingers with an alarm if each finger is evaluated alone | simulations with a warning of a change of the rig |
|---|---|---|---|
{counts}
The temperature coefficient of the gain, which `softgrip health` estimates for each finger, is {min(slopes, default=0):.4f} to {max(slopes, default=0):.4f} mm per °C.

{lists}An active alarm of an indicator suppresses further alarms of this indicator. Without the temperature, `softgrip health` reports changes of the gain of both fingers that the weather causes. The warnings that the weather causes are correct, but not useful. The results of the simulations have three limitations: all simulated fingers are of one type, their temperature equals the ambient temperature
without delay, and only the weather is correlated from day to day.
"""


def main():
    parser = results_page.arguments(__doc__)
    parser.add_argument("--healthy", type=int, default=6)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--keep", type=pathlib.Path, help="folder for the recordings; recordings that the folder already contains are used again")
    args = parser.parse_args()
    softgrip = (args.build / "tools/softgrip").resolve()
    began = time.monotonic()
    with tempfile.TemporaryDirectory(prefix="softgrip-ninety-") as temporary:
        folder = args.keep or pathlib.Path(temporary)
        lives = [(folder / "eventful", args.seed, True)]
        lives += [(folder / f"healthy-{n}", args.seed + 1 + n, False) for n in range(args.healthy)]
        with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
            list(pool.map(lambda life: live(softgrip, *life), lives))
        seen = {temperature: [(event, judged_event(softgrip, folder / "eventful", view, event)) for event in EVENTS]
                for temperature, view in TOGETHER.items()}
        eventful, *healthy = [judge_life(softgrip, path, happens) for path, _, happens in lives]
    text = page(args, seen, eventful, healthy, time.monotonic() - began)
    if args.page:
        args.page.write_text(text)
    print(text)
    return 0 if all(one and one["right"] for found in seen.values() for _, one in found) else 1


if __name__ == "__main__":
    sys.exit(main())
