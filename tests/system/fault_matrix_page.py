"""Writes docs/results/fault-matrix.md from the table of faults and the measured values."""

import pathlib
import sys

sys.path.append(str(pathlib.Path(__file__).resolve().parents[2] / "scripts"))
import results_page

EXPLANATION = """\
The [table](#the-table) shows the result of every fault (row) in every phase of a grip (column). For a latched fault, the cell also states the action of the outputs and, if it was measured, the number of cycles of the control loop until the detection.
`tests/system/fault_matrix.yaml` defines the required result of each cell. If the measured result of a cell differs from the required result, the cell is marked **WRONG** and `scripts/fault_matrix.sh` fails. The test `system.test_fault_matrix` repeats some of the cells in every test run.

- **F103 20/22 vent** (example): the daemon latched fault F103 20 cycles after the first effect of the fault, and vented the outputs. The [thresholds](#thresholds) permit 22 cycles until the detection of F103. The word *board* in a cell means that the watchdog of the board vented the outputs, because no write was possible. A cycle is a tick in the recording. The cycles are counted from the first affected message to the tick in which the fault latched.
- **waits**: the daemon stays in the state `starting` with its outputs at rest, and becomes idle when the cause is gone.
- **ridden**: no fault latches, and the grip has its normal result or the result that the cell states.
- **unseen**: the software cannot detect the fault. The note of the cell states the reason and the remaining protection.
- *spoiled*: the board does not output the written values, so the safe action of the daemon has no effect. Only protections outside the software are effective (for example a relief valve, or a dump valve in the emergency-stop circuit).

The test of every cell also checks the following conditions. After the fault, no output moved away from its rest pressure. When the cause is gone, the fault can be acknowledged, and the acknowledgement causes no motion. The recordings contain every tick that the control loop executed, and `run.json` contains the fault.
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
    return (f"The {len(results)} cells have these results: " + ", ".join(f"{n} {ends}" for ends, n in sorted(count.items())) +
            f". {len(reactions)} reaction times were measured; the reaction time nearest to its limit was {worst['cycles']} of the {worst['bound']} "
            f"permitted cycles. The tests of {tried} cells were repeated because the machine had paused during the first test.")


def meaning(results):
    wrong, unseen = (sum(bool(kind(r)) for r in results) for kind in (
        lambda r: r["wrong"], lambda r: not r["wrong"] and r["expected"]["ends"] == "unseen"))
    return (f"In {len(results) - wrong} of {len(results)} combinations of a fault and a phase of a grip (cells), softgripd has the required result. "
            f"In {unseen} of the {len(results)} cells, the software cannot detect the fault, and a note names the remaining protection.")


def page(table, results, build):
    notes = []
    lines = [*results_page.head("Fault matrix", meaning(results), results_page.version_of(build), "scripts/fault_matrix.sh --page",
                                "real daemon and emulated board over real sockets"), EXPLANATION, summary(results), "", "## Thresholds", "",
             "The tests use the rig file `config/rig_tcp.yaml` with the values in this table. The permitted numbers of cycles are computed from these values:", "",
             "| key of the rig file | value |", "|---|---|"]
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
