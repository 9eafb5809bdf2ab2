"""Inserts faults into a copy of the code, one at a time. Counts how many seeds are needed until a simulated world
detects each fault."""

import os
import re
import shutil
import subprocess
import sys

from source_copy import SOURCE, copy_sources

COPY = SOURCE / "build/worlds"
MOST_SEEDS = 2000
DAEMON_ALONE = (60, "daemon")

GAP_OF_BUS = ("daemon/loop/bus.cpp", "if (watchdog_ == 0 ||", "if (watchdog_ >= 0 ||")
GAP_BY_HAND = ("tools/commissioning/motion_session.cpp", "if (fault == control::FaultCode::board_watchdog_tripped) {",
               "if (fault == control::FaultCode::board_watchdog_tripped) return std::nullopt;\n  if (false) {")

# Each fault has a description, a file, the text to replace (which must occur exactly once) and its replacement. Two
# values are optional: the simulated time of a world [s] and the tool that runs in the world. By default, the daemon
# runs alone for 60 s.
FAULTS = (
    ("the duration of a gap in the communication is not compared with the board's watchdog time", *GAP_OF_BUS),
    ("when a stalled loop continues, its commands are written immediately", "daemon/loop/bus.cpp",
     "inhibited_ == FaultCode::none || commands.inhibit != report_.health.inhibit || commands.may_rise",
     "inhibited_ == FaultCode::none"),
    ("a command that the board has not received yet may rise after the end of its sequence", "daemon/loop/bus.cpp",
     "if (commands.may_rise && inhibited_ == FaultCode::none) return;", "if (inhibited_ == FaultCode::none) return;"),
    ("after a reconnection, a command from before the reconnection is written", "daemon/loop/bus.cpp",
     "if (!connected && shared_.commands.fetch()) unheard_ = 0;", ""),
    ("readings from before a communication gap are used as evidence of a held part", "control/tick/rig_conditions.cpp",
     "if (gap <= channels_[i].longest_age ||", "if (gap >= 0 ||"),
    ("a vent waits behind all other requests", "daemon/loop/loop.cpp",
     "if (!shared_.vents.pop(input.request) &&", "if (!shared_.requests.pop(input.request) && !shared_.vents.pop(input.request) &&"),
    ("a start is executed although a later vent was executed first", "control/tick/supervisor.cpp",
     "if (input.request.id < halted_by_ || ", "if ("),
    ("a fault is acknowledged while its cause is present", "control/tick/supervisor.cpp",
     "if (cause.code != FaultCode::none) {", "if (false) {"),
    ("the controller holds the pressure after a fault that requires venting", "control/tick/supervisor.cpp",
     "if (action_for(fault.code, fault_phase_) == SafeAction::vent) venting_ = all_;", ""),
    ("outputs that another Modbus client wrote do not cause a fault", "daemon/loop/bus.cpp", "return FaultCode::outputs_overwritten;",
     "return FaultCode::none;"),
    ("values that another Modbus client wrote between two requests are overwritten", "daemon/loop/bus.cpp", "    if (holds) continue;",
     "    if (holds || true) continue;"),
    ("the bus thread uses the lowest pressure as the rest pressure", "daemon/loop/bus.cpp",
     "rest_kpa_[i] = control::resting_kpa(rig.channels[i].limits);",
     "rest_kpa_[i] = rig.channels[i].limits.pressure_min_kpa;"),
    ("a vent sets the lowest pressure instead of the rest pressure", "control/tick/channel_controller.cpp",
     "      return resting_kpa(limits_);", "      return limits_.pressure_min_kpa;"),
    ("a command that crosses the rest pressure continues by almost three steps", "control/elements/limits.cpp",
     "  return {.command_kpa = reached,",
     "  const double past_kpa = reached - resting_kpa(limits);\n"
     "  const double slew = past_kpa > 0 ? limits.slew_up_kpa_per_s : -limits.slew_down_kpa_per_s;\n"
     "  const bool crosses = (last - resting_kpa(limits)) * past_kpa < 0;\n"
     "  return {.command_kpa = crosses ? in_range(limits, resting_kpa(limits) + 2.9 * slew * elapsed_s) : reached,"),
    ("every report of the bus thread is kept in memory", "daemon/loop/bus.cpp",
     "shared_.bus.publish(report_);",
     "shared_.bus.publish(report_);\n  static auto& kept = *new std::vector<BusReport>;\n  kept.push_back(report_);", 600),
    ("the file of every recording stays open after the end of the recording", "daemon/recording/run_folder.cpp",
     "if (descriptor_ >= 0) ::close(descriptor_);", ""),
    ("a commanded motion of calibrate continues after a gap in which the board has vented", *GAP_BY_HAND, 60, "calibrate"),
    ("a commanded motion of doctor continues after a gap in which the board has vented", *GAP_BY_HAND, 60, "doctor"),
    ("during a motion of softgrip calibrate, the duration of a gap is not compared with the board's watchdog time", *GAP_OF_BUS, 60, "calibrate"),
    ("during a motion of softgrip calibrate, softgrip reports no fault if another Modbus client writes outputs", "daemon/loop/bus.cpp",
     "return FaultCode::outputs_overwritten;", "return FaultCode::none;", 60, "calibrate"),
    ("a motion of calibrate ends without writing the safe outputs", "tools/commissioning/motion_session.cpp",
     "  targets_ = rest_;\n  double fastest = 0;", "  return true;\n  double fastest = 0;", 60, "calibrate"),
    ("softgrip-plc executes a command whose counter is not the next number (defect 2)", "tools/plc/handshake.cpp",
     "const bool follows = ahead(entry.counter) == 1 && cursor.at == newest().counter;", "const bool follows = true;",
     60, "plc"),
    ("softgrip-plc forgets the reaction to a stopped heartbeat while no daemon runs (defect 10)", "tools/plc/gateway.cpp",
     "if (!connected_ || reaction_id_ ||", "if (!connected_) heartbeat_monitor_.confirm();\n  if (!connected_ || reaction_id_ ||", 60, "plc"),
    ("softgrip run ends with exit code 0 after a signal (defect 3)", "daemon/service/daemon.cpp",
     "return outcome.safe_state_confirmed ? ExitCode::not_acceptable : ExitCode::failed;", "return done;", 60, "run"),
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


def seeds_until_found(seconds, tool):
    """Returns the first seed whose simulation detects the fault, and the violated property. Returns None if no seed
    detects the fault."""
    first, count = 1, 20
    while first <= MOST_SEEDS:
        done = run(["build/release/tests/world/softgrip-world", "--first", first, "--count", count, "--jobs", os.cpu_count(),
                    "--seconds", seconds, "--tool", tool, "--stop"])
        found = [(int(m.group(1)), m.group(2)) for m in re.finditer(r"^seed (\d+): (.*)$", done.stdout, re.MULTILINE)]
        if found:
            return min(found)
        first, count = first + count, min(2 * count, 400)
    return None


def main():
    """Inserts the faults whose description contains one of the arguments. Without arguments, inserts all faults. With
    --check, only checks that the text of each fault occurs exactly once in its file."""
    words = [word for word in sys.argv[1:] if word != "--check"]
    chosen = [fault for fault in FAULTS if any(word in fault[0] for word in words or [""])]
    stale = [f"{name} does not contain this text exactly once: {old}" for _, name, old, *_ in chosen
             if (SOURCE / name).read_text().count(old) != 1]
    if stale or "--check" in sys.argv:
        sys.exit("\n".join(stale) or 0)
    prepare()
    missed = 0
    print("| inserted error | simulated program | first seed that detects the error | violated invariant |\n|---|---|---|---|", flush=True)
    for what, name, old, new, *rest in chosen:
        seconds, tool = [*rest, *DAEMON_ALONE[len(rest):]]
        path = COPY / name
        text = path.read_text()
        path.write_text(text.replace(old, new))
        build()
        found = seeds_until_found(seconds, tool)
        path.write_text(text)
        missed += found is None
        seed, invariant = found or (f"none of {MOST_SEEDS}", "")
        print(f"| {what} | {tool} | {seed}{f' ({seconds} s)' if seconds != 60 else ''} | {invariant} |", flush=True)
    return 1 if missed else 0


if __name__ == "__main__":
    sys.exit(main())
