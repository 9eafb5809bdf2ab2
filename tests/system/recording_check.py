"""Checks that recordings have the properties that docs/reliability.md states: recording_check.py RECORDING...

The script reads run.csv and run.json. It also reads the rig file to which run.json refers, if this file has not
changed since the recording. If a recording does not have a property, the exit code is 6, and the message states the
row.
"""

import argparse
import csv
import hashlib
import json
import math
import pathlib
import sys

import yaml

# States in which a command may move away from the rest pressure. They must equal those in may_rise() of
# control/tick/tick.h.
MAY_RISE = ("resynchronising", "running")
# Maps a state to the states that may follow it. The map must equal that in control/tick/supervisor.h.
NEXT = {
    "starting": ("idle", "faulted"),
    "idle": ("resynchronising", "running", "stopping", "faulted"),
    "resynchronising": ("running", "idle", "stopping", "faulted"),
    "running": ("idle", "stopping", "faulted"),
    "stopping": ("idle", "faulted"),
    "faulted": ("starting", "idle"),
}
# Tolerance of a value, because the cells of run.csv have six decimals.
CELL = 2e-6


class Recording:
    def __init__(self, folder):
        self.folder = folder
        self.wrong = []
        self.about = json.loads((folder / "run.json").read_text())
        with open(folder / "run.csv", newline="") as file:
            self.rows = [row for row in csv.DictReader(file) if None not in row.values()]
        self.names = self.channel_names()
        self.rest_kpa = {}
        self.limits = self.rig_limits()

    def channel_names(self):
        """Returns the names of the channels in the order of their rows in run.csv."""
        return list(dict.fromkeys(row["channel"] for row in self.rows))

    def rig_limits(self):
        """Returns the limits of each channel. The result is empty if the rig file was removed or changed after the
        recording."""
        for file in self.about["files"]:
            path = pathlib.Path(file["path"])
            if file["role"] != "rig" or not path.exists():
                continue
            data = path.read_bytes()
            if hashlib.sha256(data).hexdigest() == file["sha256"]:
                rig = yaml.load(data, Loader=yaml.CSafeLoader)  # 6 times faster than the loader in Python
                shared = rig.get("channel_defaults", {})
                self.rest_kpa = {c["name"]: {**shared, **c}.get("rest_kpa", 0) for c in rig["channels"]}
                return {c["name"]: {**shared.get("limits", {}), **c.get("limits", {})} for c in rig["channels"]}
        return {}

    def rest(self, name):
        """Returns the rest pressure of a channel: rest_kpa of the rig file, limited to the pressure limits of the
        channel."""
        limits = self.limits.get(name)
        rest = self.rest_kpa.get(name, 0)
        return rest if limits is None else max(limits["pressure_min_kpa"], min(rest, limits["pressure_max_kpa"]))

    def says(self, row, sentence):
        self.wrong.append(f"{self.folder.name}: {float(row['time_s']):.6f} s, {row['channel']}: {sentence}")

    def check(self):
        self.check_whole()
        for name in self.names:
            rows = [row for row in self.rows if row["channel"] == name]
            self.check_range(name, rows)
            for before, row in zip(rows, rows[1:]):
                self.check_step(name, before, row)
                self.check_return(name, before, row, last=row is rows[-1])
            self.check_results(rows)
        self.check_events()
        return self.wrong

    # --- Checks that the recording is complete

    def check_whole(self):
        """Checks that every recorded tick has one row for each channel, in the same order. Also checks that the times
        increase, and that the number of rows is the number in run.json."""
        for index, row in enumerate(self.rows):
            if row["channel"] != self.names[index % len(self.names)]:
                self.says(row, f"row {index + 2} is out of order")
                return
        for before, row in zip(self.rows, self.rows[1:]):
            same = row["channel"] != self.names[0]
            if (row["time_s"] != before["time_s"]) if same else (float(row["time_s"]) <= float(before["time_s"])):
                self.says(row, f"its time follows {before['time_s']}")
                return
        if self.about["state"] == "complete" and self.about["rows"] != len(self.rows):
            self.wrong.append(f"{self.folder.name}: {len(self.rows)} rows, but run.json says {self.about['rows']}")

    # --- Checks of the outputs

    def check_range(self, name, rows):
        limits = self.limits.get(name)
        if limits is None:
            return
        for row in rows:
            command = float(row["pressure_command_kpa"])
            if not limits["pressure_min_kpa"] - CELL <= command <= limits["pressure_max_kpa"] + CELL:
                self.says(row, f"{command} kPa is out of the range of its limits")

    def check_step(self, name, before, row):
        """Checks two successive recorded ticks. The state may change as NEXT permits, and in no other way. During a
        sequence, a command may move away from rest within the slew limit. Outside a sequence, it must not move away
        from rest."""
        if row["state"] != before["state"] and row["state"] not in NEXT[before["state"]]:
            self.says(row, f"{before['state']} is followed by {row['state']}")
        for side, slew in ((1, "slew_up_kpa_per_s"), (-1, "slew_down_kpa_per_s")):
            change = self.away(name, row, side) - self.away(name, before, side)
            if change <= CELL:
                continue
            if row["state"] not in MAY_RISE:
                self.says(row, f"the command moves away from rest by {change:.6f} kPa while {row['state']}")
            if name in self.limits and change > self.allowed(name, slew) + CELL:
                self.says(row, f"the command leaves rest by {change:.6f} kPa from one row to the next, "
                               f"but the slew limit permits {self.allowed(name, slew):.6f} kPa")

    def check_return(self, name, before, row, last):
        """Checks that the return to rest stays within the slew limit. Exceptions are the safe outputs during a fault
        and at the end of the recording, because they are written in one step."""
        if name not in self.limits or row["state"] == "faulted" or last:
            return
        for side, slew in ((1, "slew_down_kpa_per_s"), (-1, "slew_up_kpa_per_s")):
            change = self.away(name, before, side) - self.away(name, row, side)
            if change > self.allowed(name, slew) + CELL:
                self.says(row, f"the command returns to rest by {change:.6f} kPa from one row to the next, "
                               f"but the slew limit permits {self.allowed(name, slew):.6f} kPa")

    def away(self, name, row, side):
        """Returns the distance of a command from the rest pressure. Commands above the rest pressure count as
        positive if side is 1, and commands below it if side is -1."""
        return max(0.0, side * (float(row["pressure_command_kpa"]) - self.rest(name)))

    def allowed(self, name, slew):
        """Returns the largest permitted change of a command in a tick. If the loop has missed a tick, a larger change
        is not permitted."""
        return self.limits[name][slew] * self.about["decimation"] / self.about["rate_hz"]

    # --- Checks of results and events

    def check_results(self, rows):
        """Checks that the result HOLDING begins with evidence. The evidence is a valid displacement or a measured
        pressure."""
        for before, row in zip(rows, rows[1:]):
            if row["result"] != "holding" or before["result"] == "holding":
                continue
            seen = row["validity"] == "valid" or math.isfinite(float(row.get("pressure_kpa") or "nan"))
            if not seen or before["state"] != "running":
                self.says(row, f"HOLDING from a reading that is {row['validity']}, while {before['state']}")

    def check_events(self):
        """Checks that the events are in order. Also checks that no sequence runs between a fault and the
        acknowledgement of this fault."""
        faulted = None
        time_s, number = -math.inf, 0
        for event in self.about["events"]:
            if event["time_s"] < time_s:
                self.wrong.append(f"{self.folder.name}: event {event['kind']} at {event['time_s']} s follows {time_s} s")
            if event.get("id", number + 1) <= number:
                self.wrong.append(f"{self.folder.name}: event {event['id']} follows event {number}")
            time_s, number = event["time_s"], event.get("id", number + 1)
            if event["kind"] == "fault_latched":
                faulted = event
            elif event["kind"] == "fault_acknowledged":
                faulted = None
            elif event["kind"] == "sequence_started" and faulted:
                self.wrong.append(f"{self.folder.name}: a sequence starts at {time_s} s under {faulted['code']}")


def check(folder):
    """Returns a sentence for each property of docs/reliability.md that a recording does not have."""
    return Recording(pathlib.Path(folder)).check()


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("recordings", nargs="+", type=pathlib.Path)
    wrong = [sentence for folder in parser.parse_args().recordings for sentence in check(folder)]
    for sentence in wrong:
        print(sentence)
    return 6 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
