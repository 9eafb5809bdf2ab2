"""Writes docs/results/fault-matrix.md from the table of faults and the measured values."""

import pathlib
import sys

sys.path.append(str(pathlib.Path(__file__).resolve().parents[2] / "scripts"))
import results_page

EXPLANATION = """\
This page shows every fault in every phase of a grip: the result, the number of cycles of the loop, and the outputs at the board.
`tests/system/fault_matrix.yaml` defines the required result of each cell. A cell with another result is marked **WRONG** and fails
the command. A part of it runs with every test (`system.test_fault_matrix`).

- **F103 20/22 vent**: this fault latched 20 cycles after its first effect, where 22 are allowed by the thresholds below. Then the
  outputs were vented. *board*: the board's own watchdog vented them, because no write was possible. The cycles are ticks in the
  recording, from the first affected message to the tick that latched.
- **waits**: the daemon stays in `starting`, outputs at rest, and becomes idle when the cause is gone.
- **ridden**: no fault, and the grip has its normal result.
- **unseen**: the software cannot detect the fault. The note gives the reason and the remaining protection.
- *spoiled*: a write does not arrive unchanged, so no safe action of the daemon helps, only the protection of board and bench
  (relief valve, dump valve in the emergency-stop circuit).

Every cell also checks these conditions: no output moved away from rest after the fault; the fault is acknowledged once its cause is
gone, and this causes no motion; recordings are complete, without a missing row except for ticks that the loop itself lost; and `run.json`
contains the fault.
"""


def text_of(result, notes):
    expected, measured = result["expected"], result["measured"]
    if result["wrong"]:
        return f"**WRONG** {result['wrong'].splitlines()[0][:80]}"
    if result.get("skipped"):
        return f"not run: {result['skipped']}"
    text = expected["ends"]
    if text == "faulted":
        text = measured["code"]
        if "cycles" in measured:
            text += f" {measured['cycles']}/{measured['bound']}"
        text += " *spoiled*" if expected.get("outputs") == "spoiled" else f" {measured.get('outputs', '')}"
        text += " *board*" if measured.get("by") == "board" else ""
    elif expected.get("result"):
        text += f" {expected['result']}"
    if "why" in expected:
        if expected["why"] not in notes:
            notes.append(expected["why"])
        text += f" [{notes.index(expected['why']) + 1}]"
    return text.strip()


def summary(results):
    count = {}
    for result in results:
        ends = "wrong" if result["wrong"] else "not run" if result.get("skipped") else result["expected"]["ends"]
        count[ends] = count.get(ends, 0) + 1
    reactions = [r["measured"] for r in results if "cycles" in r["measured"]]
    worst = max(reactions, key=lambda m: m["cycles"] / m["bound"])
    tried = sum(r["attempts"] > 1 for r in results)
    return (f"{len(results)} cells: " + ", ".join(f"{n} {ends}" for ends, n in sorted(count.items())) +
            f". {len(reactions)} reactions were measured; the one nearest to its bound took {worst['cycles']} of {worst['bound']} "
            f"cycles. {tried} cells were repeated after a pause of the machine.")


def meaning(results):
    wrong, unseen = (sum(bool(kind(r)) for r in results) for kind in (
        lambda r: r["wrong"], lambda r: not r["wrong"] and r["expected"]["ends"] == "unseen"))
    return (f"{len(results) - wrong} of {len(results)} cells have the required result, but in {unseen} of them the software cannot "
            "detect the fault, and the note states the remaining protection.")


def page(table, results, build):
    notes = []
    lines = [*results_page.head("Fault matrix", meaning(results), results_page.version_of(build), "scripts/fault_matrix.sh --page",
                                "real daemon and emulated board over real sockets"), EXPLANATION, summary(results), "", "## Thresholds", "",
             "The rig is `config/rig_tcp.yaml` with these changes. The allowed numbers of cycles are computed from them:", "",
             "| key | |", "|---|---|"]
    lines += [f"| `{key}` | {value} |" for key, value in table.rig.items()]
    lines += ["", "## The table", "", "| class | fault | " + " | ".join(table.phases) + " |",
              "|---|---|" + "---|" * len(table.phases)]
    by_cell = {(r["fault"], r["phase"]): r for r in results}
    for name, fault in table.faults.items():
        cells = [text_of(by_cell[(name, phase)], notes) if (name, phase) in by_cell else "" for phase in table.phases]
        lines.append(f"| {fault['class']} | `{name}`: {fault['about']} | " + " | ".join(cells) + " |")
    lines += ["", "## Notes", ""]
    lines += [f"{i}. {note}" for i, note in enumerate(notes, 1)]
    return "\n".join(lines) + "\n"
