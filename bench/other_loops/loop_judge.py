"""Writes the logs of the simulated loops with the table that bench/foreign.py reads, and judges the answers of softgrip."""
import json

from outcomes import UNREADABLE, Failed, described, write_whole
from runner import Runner
import judge_stiction
import set_table

import loop_kinds

COLUMNS = ("time_s", "pressure_command_kpa", "displacement_mm")
SHARES = ((0, 0.2), (0.2, 0.5), (0.5, 100))  # S as a share of the span of the controller output


def log_text(columns):
    rows = (",".join(f"{value:.9g}" for value in row) for row in zip(*(columns[name] for name in COLUMNS)))
    return "\n".join([",".join(COLUMNS), *rows, ""])


def table_text(half):
    return "\n".join([f'title: "Simulated control loops, {half} half"',
                      "about: simulated by bench/other_loops.py, not measured",
                      f"same: {{time: {COLUMNS[0]}, command: {COLUMNS[1]}, displacement: {COLUMNS[2]}}}",
                      "logs:", '- {file: "*.csv"}', "stiction:", '- {logs: "stick_*", sticks: true}',
                      '- {logs: "other_*", sticks: false}', "identification: []", ""])


def write_half(half, folder, plan=None):
    """Simulates the loops of a half, and writes their logs, the table foreign.yaml and the labels labels.json."""
    folder.mkdir(parents=True, exist_ok=True)
    labels = {}
    for arguments in plan or loop_kinds.planned(half):
        loop = loop_kinds.built(*arguments)
        (folder / f"{loop.name}.csv").write_text(log_text(loop.columns))
        labels[loop.name] = {"kind": loop.kind, **loop.facts}
    (folder / set_table.OWN_TABLE).write_text(table_text(half))
    write_whole(folder / "labels.json", json.dumps(labels, indent=1) + "\n")


def judged_half(options, half):
    """Yields the cases of a half."""
    folder = options.logs / half
    labels = json.loads((folder / "labels.json").read_text())
    data_set = set_table.read_set(folder / set_table.OWN_TABLE, folder)
    runner = Runner(options.program, options.out / "answers", 1, options.at_most_s)
    for loop in data_set.loops:
        case = {"half": half, "loop": loop.log, "sticks": loop.sticks, **labels[loop.log]}
        if options.kinds and case["kind"] not in options.kinds:
            continue
        try:
            case.update(judge_stiction.judge_loop(runner, data_set, loop))
            case["outcome"] = "named" if case["stiction_named"] else "listed" if case["stiction_listed"] else "not"
        except (Failed, *UNREADABLE) as failed:
            case.update(verdict="-", named=[], alternatives=[], partial=[], sizes=[], outcome="failed", error=described(failed),
                        horch="-", drift_alone=False, diagnosis_s=None)
        yield {**case, **runner.cost()}


def group_of(case):
    return "others" if not case["sticks"] else "visible" if case["visible"] else "hidden"


def counts(cases):
    """Returns rows (sentence, count, total) for the cases of one half. An error of softgrip counts as not named."""
    good = [case for case in cases if case["outcome"] != "failed"]
    rows = []
    for group, text in (("visible", "sticking valves with a visible effect"),
                        ("hidden", "sticking valves without a visible effect"), ("others", "other loops")):
        outcomes = [case["outcome"] for case in cases if group_of(case) == group]
        if not outcomes:
            continue
        tested = [case["horch"] for case in good if group_of(case) == group]
        rows += [(f"{text}: `valve_deadband` named", outcomes.count("named"), len(outcomes)),
                 (f"{text}: `valve_deadband` named or listed", outcomes.count("named") + outcomes.count("listed"),
                  len(outcomes)),
                 (f"{text}: softgrip reported an error", outcomes.count("failed"), len(outcomes)),
                 (f"{text} without an error: reported as sticking by Horch's phase test", tested.count("sticks"),
                  len(tested))]
    return [*rows, ("all loops: `sensor_drift` named alone", sum(case["drift_alone"] for case in cases), len(cases))]


def share_text(limits):
    return f"{100 * limits[0]:g} to {100 * limits[1]:g} %" if limits[1] < 100 else f"above {100 * limits[0]:g} %"


def groups_of_sticking(cases):
    """Yields (text, cases) for the sticking loops with a visible effect: by model, process, share, and with J = 0."""
    visible = [case for case in cases if group_of(case) == "visible"]
    for key, text in (("model", "model"), ("process", "process")):
        for value in sorted({case[key] for case in visible}):
            yield f"{text}: {value.replace('_', ' ')}", [case for case in visible if case[key] == value]
    for low, high in SHARES:
        yield f"S is {share_text((low, high))} of the span of the output", [case for case in visible
                                                                           if low <= case["share"] < high]
    yield "J = 0 (deadband without jump)", [case for case in visible if case["jump"] == 0]
    yield "effect of 4 to 10 times the noise", [case for case in visible if case["effect_to_noise"] < 10]
    yield "effect above 10 times the noise", [case for case in visible if case["effect_to_noise"] >= 10]
