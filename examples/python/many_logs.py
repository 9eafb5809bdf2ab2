"""Identifies many logs in parallel with one process per processor core. `many_logs.py LOG...` prints a line for each
log."""

import sys
from concurrent.futures import ProcessPoolExecutor

import softgrip


def identified(file: str) -> str:
    try:
        found = softgrip.identify(softgrip.Log.read(file), starts=5, threads=1)
    except softgrip.SoftgripError as error:
        return f"{file}: {error}"
    return f"{file}: RMSE {found.rmse:.3g} {found.model.unit}, {len(found.warnings)} warnings"


def main(files: list[str]) -> None:
    with ProcessPoolExecutor() as pool:
        for line in pool.map(identified, files):
            print(line)


if __name__ == "__main__":
    main(sys.argv[1:])
