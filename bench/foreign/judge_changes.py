"""Implements judges 1 and 2: repeated runs between which nothing changed, and changes that the laboratory labelled.

Each pair is diagnosed by `softgrip diagnose --healthy BASELINE --data LATER` with the model that `softgrip identify`
fits to the baseline. The change is also measured without a diagnosis. For this purpose, the error of the model on the
later run is compared with its errors on healthy runs that were left out of the fit.
"""
import math
import statistics

from scipy import stats

from outcomes import Failed
from runner import names_in, result_of, rms, slug

UNCHANGED = "unchanged"
PROBABILITY = 0.95


def healthy_bound(errors):
    """Returns an upper bound for the error of one additional healthy run. The error is below this bound with the
    probability PROBABILITY (one-sided prediction bound, Student's t)."""
    n = len(errors)
    if n < 2:
        return None
    quantile = stats.t.ppf(PROBABILITY, n - 1)
    return statistics.mean(errors) + float(quantile) * statistics.stdev(errors) * math.sqrt(1 + 1 / n)


def plain_model(runner, data_set, healthy, later):
    """Identifies a model from the healthy runs. Returns the folder of the model, and the errors of the model [mm] on
    the fitted, the left-out and the later runs."""
    folder, outcome = runner.identify(data_set, healthy, [later])
    answer = result_of(outcome)
    errors = {"fitted_mm": rms(list(answer["rmse_mm"].values())), "later_mm": answer["validation"]["rmse_mm"][later.key],
              "left_out_mm": []}
    if len(healthy) > 1:
        for left_out in healthy:
            others = [log for log in healthy if log is not left_out]
            answer = result_of(runner.identify(data_set, others, [left_out])[1])
            errors["left_out_mm"].append(answer["validation"]["rmse_mm"][left_out.key])
    bound = errors["healthy_bound_mm"] = healthy_bound(errors["left_out_mm"])
    errors["over_fitted"] = errors["later_mm"] / errors["fitted_mm"]
    errors["over_bound"] = errors["later_mm"] / bound if bound else None
    return folder, errors


def judged_label(pair, names, exceeds):
    """Judges the diagnosis of a labelled change. Returns the keys that a case of the judge `changes` has in addition to
    the common keys."""
    alternatives = {rival for rivals in names["alternatives"] for rival in rivals}
    named = bool(set(pair.causes) & set(names["named"]))
    listed = named or bool(set(pair.causes) & alternatives)
    return {"exceeds_spread": exceeds, "named_correctly": named, "listed": listed,
            "wrong_alone": bool(names["named"]) and not listed}


def judge_pair(runner, data_set, pair, judge):
    """Diagnoses one pair of logs and returns its case, without the computing times."""
    if pair.problems:
        raise Failed("\n".join(pair.problems))
    healthy = [runner.log(data_set, name) for name in pair.baseline]
    later = runner.log(data_set, pair.later)
    folder, plain = plain_model(runner, data_set, healthy, later)
    diagnosis = result_of(runner.diagnose(runner.out / data_set.name / judge / slug(pair.name), folder / "model.yaml",
                                          [later], healthy))
    names = names_in(diagnosis)
    case = {"baseline_runs": len(healthy), "span_mm": later.span_mm, "plain": plain, **names,
            "changed": names["verdict"] != UNCHANGED, "diagnosis_s": diagnosis["wall_s"]}
    if judge == "changes":
        exceeds = None if plain["over_bound"] is None else plain["over_bound"] > 1
        case.update(label=pair.label, causes=list(pair.causes), **judged_label(pair, names, exceeds))
    return case


def said(case):
    """Returns a short description of a case."""
    text = "changed" if case["changed"] else "unchanged"
    if case["named"]:
        text += ": " + ", ".join(case["named"])
    if case["judge"] == "changes":
        text += " (correct)" if case["named_correctly"] else " (listed)" if case["listed"] else ""
    return text


def summary_of_repeats(cases):
    groups = {}
    for case in cases:
        group = groups.setdefault(case["group"], {"cases": 0, "failed": 0, "changed": 0, "sensor_drift": 0, "by_runs": {}})
        if "error" in case:
            group["failed"] += 1
            continue
        group["cases"] += 1
        group["changed"] += case["changed"]
        group["sensor_drift"] += "sensor_drift" in case["named"]
        of_runs = group["by_runs"].setdefault(str(case["baseline_runs"]), {"cases": 0, "changed": 0})
        of_runs["cases"] += 1
        of_runs["changed"] += case["changed"]
    return groups


def summary_of_changes(cases):
    good = [case for case in cases if "error" not in case]
    beyond = [case for case in good if case["exceeds_spread"]]
    within = [case for case in good if case["exceeds_spread"] is False]
    detected = [case for case in beyond if case["changed"]]
    return {"changed": sum(case["changed"] for case in good), "listed": sum(case["listed"] for case in good),
            "cases": len(good), "failed": len(cases) - len(good), "beyond_spread": len(beyond), "detected": len(detected),
            "named_or_listed": sum(case["listed"] for case in detected), "within_spread": len(within),
            "within_reported_unchanged": sum(not case["changed"] for case in within),
            "wrong_alone": sum(case["wrong_alone"] for case in good)}
