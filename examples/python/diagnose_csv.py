"""Diagnoses a finger from a file of another program. Usage: diagnose_csv.py FILE [REPORT.html]"""

import sys

import softgrip


def main(file: str, report: str = "") -> None:
    log = softgrip.Log.read(file)
    for note in log.notes:
        print("note:", note)
    fitted = softgrip.identify(log, starts=5)
    print(fitted.verdict)
    diagnosis = softgrip.diagnose(fitted.model, log)
    print(diagnosis.sentence)
    for cause in diagnosis.causes:
        for parameter in cause.parameters:
            interval = "" if parameter.ci95 is None else " (95 %%: %.4g to %.4g)" % parameter.ci95
            print(f"{cause.id}: {parameter.name} = {parameter.value:.4g} {parameter.unit}{interval}")
    if report:
        diagnosis.save_html(report)


if __name__ == "__main__":
    main(*sys.argv[1:])
