"""Compares two fingers by the 95 % intervals of their parameters. Usage: compare_fingers.py LOG_A LOG_B"""

import sys

import softgrip


def main(log_a: str, log_b: str) -> None:
    a, b = (softgrip.identify(softgrip.Log.read(file), starts=5) for file in (log_a, log_b))
    print(a.verdict, b.verdict, sep="\n")
    different = 0
    for one, other in zip(a.parameters, b.parameters):
        if one.ci95 is None or other.ci95 is None:
            continue
        if one.ci95[0] > other.ci95[1] or other.ci95[0] > one.ci95[1]:
            different += 1
            print(f"{one.name:32} {one.value:10.4g} {other.value:10.4g} {one.unit}")
    print(f"{different} of {len(a.parameters)} parameters differ")


if __name__ == "__main__":
    main(*sys.argv[1:])
