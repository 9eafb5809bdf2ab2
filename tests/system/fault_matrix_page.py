"""docs/reference/fault-matrix.md out of the table and what was measured."""

HEAD = """# Fault matrix

Every fault in every phase of a grip, against the real daemon over real sockets: what it came to, how many cycles of the
loop it took, and what the outputs did as the board had them. Made by

```
$ scripts/fault_matrix.sh --page
```

from `tests/system/fault_matrix.yaml`, which says for every cell what must come of it; a cell that came to anything else
is marked **WRONG** here and fails the command. A part of it runs with every test (`system.test_fault_matrix`).

- **F103 20/22 vent**: this fault latched 20 cycles after its first effect, where 22 are allowed by the thresholds below;
  then the outputs were vented. *board* says that the board's own watchdog did it because nothing could be written.
  Counted are ticks in the recording, from the first message that was touched to the tick that latched.
- **waits**: the daemon stays in `starting`, outputs at rest, and becomes idle when the cause is gone.
- **ridden**: no fault, and the grip's result is what it would have been.
- **unseen**: something is wrong and the software cannot know. The note says why, and what is the guard instead.
- *spoiled*: what is written does not arrive as it was written, so no safe action of the daemon helps, only the means of
  board and bench (relief valve, dump valve in the emergency-stop circuit).

With every cell it was checked that no output moved away from rest after the fault, that a fault is acknowledged once its cause is gone
and moves nothing, that recordings are complete, no row missing between the first and the last but for ticks that the
loop itself lost, and that the fault stands in `run.json`.
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
            f". Of {len(reactions)} reactions the one nearest to its bound took {worst['cycles']} of {worst['bound']} "
            f"cycles. {tried} cells were tried a second time after the machine had stood still.")


def page(table, results):
    notes = []
    lines = [HEAD, summary(results), "", "## Thresholds", "",
             "`config/rig_tcp.yaml` with these changes; bounds are expressions of them:", "",
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
