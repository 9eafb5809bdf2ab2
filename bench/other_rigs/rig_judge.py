"""Diagnoses the runs of the simulated rigs with `softgrip diagnose --healthy`, and compares the answers with the labels."""
from outcomes import Failed
from runner import Runner, names_in, result_of
import judge_changes
import set_table

import rig_files

REPEATS, CHANGES = ("same", "other"), "change"
OUTCOMES = {"correct": "a repeat that is reported as unchanged",
            "false alarm": "a repeat that is reported as changed",
            "named": "a change whose cause, or a cause that gives the same readings, is named",
            "listed": "a change whose cause is an alternative of a named cause",
            "wrong": "a change for which only wrong causes are named",
            "unnamed": "a change that is detected, without a named cause",
            "missed": "a change that is reported as unchanged",
            "failed": "softgrip reported an error"}


def outcome_of(pair, names):
    """Returns the outcome of a case. A pair without a label is a repeat."""
    if not pair.label:
        return "correct" if names["verdict"] == judge_changes.UNCHANGED else "false alarm"
    if names["verdict"] == judge_changes.UNCHANGED:
        return "missed"
    label = judge_changes.judged_label(pair, names, None)
    if label["named_correctly"]:
        return "named"
    return "listed" if label["listed"] else "wrong" if label["wrong_alone"] else "unnamed"


def answer_folder(runner, data_set, pair):
    return runner.out / data_set.name / "diagnose" / pair.later


def diagnosed(runner, data_set, pair, healthy):
    """Returns the verdict and the names for a pair with the first `healthy` runs of its baseline."""
    if pair.problems:
        raise Failed("\n".join(pair.problems))
    baseline = [runner.log(data_set, name) for name in pair.baseline[:healthy]]
    folder, fit = runner.identify(data_set, baseline)
    result_of(fit)
    later = runner.log(data_set, pair.later)
    answer = result_of(runner.diagnose(answer_folder(runner, data_set, pair), folder / "model.yaml", [later], baseline))
    return names_in(answer)


def judged_rig(options, rig, healthy, labels):
    """Yields the cases of a rig."""
    folder = options.logs / rig.name
    data_set = set_table.read_set(folder / set_table.OWN_TABLE, folder)
    runner = Runner(options.program, options.out / f"healthy{healthy}", 1, options.at_most_s)
    for pair in (*data_set.repeats, *data_set.changes):
        if options.stored and not (answer_folder(runner, data_set, pair) / "outcome.json").is_file():
            continue
        known = labels[rig.name, pair.later]
        case = {"rig": rig.name, "log": pair.later, "healthy": healthy, "group": pair.group if not pair.label else CHANGES,
                "cause": known["cause"], "admissible": list(pair.causes), "text": known["text"],
                "ratio": float(known["ratio"]) if known["ratio"] else None}
        try:
            names = diagnosed(runner, data_set, pair, healthy)
            case.update(names, outcome=outcome_of(pair, names))
        except Failed as failed:
            case.update(verdict="-", named=[], alternatives=[], sizes=[], outcome="failed", error=str(failed))
        yield {**case, **runner.cost()}


def has_wrong_addition(case):
    """Returns True if a case names a correct cause and, in addition, a cause that is not correct."""
    return case["outcome"] == "named" and any(name not in case["admissible"] for name in case["named"])


def counts(cases):
    """Returns rows (sentence, count, total) for the cases of one number of healthy runs."""
    good = [case for case in cases if case["outcome"] != "failed"]
    rows = []
    for group in REPEATS:
        of_group = [case for case in good if case["group"] == group]
        rows.append((f"repeats with {'the same kind' if group == 'same' else 'another kind'} of input: reported as changed",
                     sum(case["outcome"] == "false alarm" for case in of_group), len(of_group)))
    changes = [case for case in good if case["group"] == CHANGES]

    def number(*outcomes):
        return sum(case["outcome"] in outcomes for case in changes)
    detected = len(changes) - number("missed")
    rows += [("changes: detected", detected, len(changes)),
             ("changes: correct cause named", number("named"), len(changes)),
             ("changes: correct cause named or listed", number("named", "listed"), len(changes)),
             ("changes: only wrong causes named", number("wrong"), len(changes)),
             ("changes: detected without a name", number("unnamed"), len(changes)),
             ("changes: correct cause named, and a wrong cause in addition", sum(map(has_wrong_addition, changes)),
              len(changes))]
    return rows


def selected(patterns):
    """Returns the rigs with the given names, or all rigs. Raises KeyError for an unknown name."""
    return [rig_files.RIGS[name] for name in patterns] if patterns else list(rig_files.RIGS.values())
