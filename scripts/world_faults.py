"""Puts faults into a copy of the code, one at a time, and counts the seeds until a world finds each."""

import os
import re
import shutil
import subprocess
import sys

from source_copy import SOURCE, copy_sources

COPY = SOURCE / "build/worlds"
MOST_SEEDS = 2000

# What is broken, where, and how: text that must be there once, what stands there instead, and how long a world lives for it
# [s] where a minute is too short to show.
FAULTS = (
    ("the gap of a paused bus is not compared with the board's watchdog (defect 1)", "daemon/loop/bus.cpp",
     "if (watchdog_ == 0 ||", "if (watchdog_ >= 0 ||"),
    ("a loop that was silent is obeyed at once (defect 2)", "daemon/loop/bus.cpp",
     "inhibited_ == FaultCode::none || commands.inhibit != report_.health.inhibit || commands.may_rise",
     "inhibited_ == FaultCode::none"),
    ("what a sequence left on its way may rise after its end", "daemon/loop/bus.cpp",
     "if (commands.may_rise && inhibited_ == FaultCode::none) return;", "if (inhibited_ == FaultCode::none) return;"),
    ("a lost session writes what was commanded before it was rebuilt", "daemon/loop/bus.cpp",
     "if (!connected && wires_.commands.fetch()) unheard_ = 0;", ""),
    ("readings from before a gap count as evidence", "control/tick/rig_controller.cpp",
     "if (gap <= channels_[i].longest_age ||", "if (gap >= 0 ||"),
    ("a vent waits behind all other requests", "daemon/loop/loop.cpp",
     "if (!wires_.vents.pop(input.request) && !wires_.stops.pop(input.request)) {\n    wires_.requests.pop(input.request);\n  }",
     "if (!wires_.requests.pop(input.request) && !wires_.stops.pop(input.request)) {\n    wires_.vents.pop(input.request);\n  }"),
    ("a start that a vent has overtaken moves nevertheless", "control/tick/supervisor.cpp",
     "if (input.request.id < halted_by_) return RefusalCode::overtaken;", ""),
    ("acknowledging a fault that is still there", "control/tick/supervisor.cpp",
     "if (cause.code != FaultCode::none) {", "if (false) {"),
    ("a fault holds where it should vent", "control/tick/supervisor.cpp",
     "if (action_for(fault.code, fault_phase_) == SafeAction::vent) venting_ = all_;", ""),
    ("what another master wrote is no fault", "daemon/loop/bus.cpp", "return FaultCode::outputs_overwritten;",
     "return FaultCode::none;"),
    ("every report of the bus is kept", "daemon/loop/bus.cpp",
     "wires_.bus.publish(report_);",
     "wires_.bus.publish(report_);\n  static auto& kept = *new std::vector<BusReport>;\n  kept.push_back(report_);", 600),
    ("the file of every recording stays open", "daemon/recording/run_folder.cpp",
     "if (descriptor_ >= 0) ::close(descriptor_);", ""),
)


def run(arguments, **keys):
    return subprocess.run([str(a) for a in arguments], cwd=COPY, capture_output=True, text=True, **keys)


def prepare():
    shutil.rmtree(COPY, ignore_errors=True)
    copy_sources(COPY)
    done = run(["cmake", "--preset", "release", "-DSOFTGRIP_TESTS=ON", "-DSOFTGRIP_WERROR=OFF",
                "-DSOFTGRIP_PRECOMPILE=ON"])
    if done.returncode:
        sys.exit(done.stderr)


def build():
    done = run(["cmake", "--build", "build/release", "--target", "softgrip-world"])
    if done.returncode:
        sys.exit(done.stdout[-3000:])


def seeds_until_found(seconds):
    """The first seed that finds it and what it violates, or None."""
    first, count = 1, 20
    while first <= MOST_SEEDS:
        done = run(["build/release/tests/world/softgrip-world", "--first", first, "--count", count, "--jobs", os.cpu_count(),
                    "--seconds", seconds, "--stop"])
        found = [(int(m.group(1)), m.group(2)) for m in re.finditer(r"^seed (\d+): (.*)$", done.stdout, re.MULTILINE)]
        if found:
            return min(found)
        first, count = first + count, min(2 * count, 400)
    return None


def main():
    """Of those faults whose words hold one of the arguments; without: of all."""
    chosen = [fault for fault in FAULTS if any(word in fault[0] for word in sys.argv[1:] or [""])]
    for _, name, old, *_ in chosen:
        if (SOURCE / name).read_text().count(old) != 1:
            sys.exit(f"{name} does not hold this once: {old}")
    prepare()
    missed = 0
    print("| what was put into the code | found by seed | the invariant it violates |\n|---|---|---|", flush=True)
    for what, name, old, new, *lives in chosen:
        seconds = lives[0] if lives else 60
        path = COPY / name
        text = path.read_text()
        path.write_text(text.replace(old, new))
        build()
        found = seeds_until_found(seconds)
        path.write_text(text)
        missed += found is None
        seed, invariant = found or (f"none of {MOST_SEEDS}", "")
        print(f"| {what} | {seed}{f' ({seconds} s)' if seconds != 60 else ''} | {invariant} |", flush=True)
    return 1 if missed else 0


if __name__ == "__main__":
    sys.exit(main())
