"""Simulates a finger. `simulate_finger.py MODEL.yaml [OUT.csv]` prints the range of the readings and writes a log."""

import sys

import numpy as np

import softgrip


def main(model_file: str, out: str = "") -> None:
    model = softgrip.Model.load(model_file)
    t = np.arange(0, 20, 0.01)
    pressure = 30 - 30 * np.cos(0.4 * np.pi * t)
    displacement = model.simulate(t, pressure)
    print(f"{model.name}: {displacement.min():.2f} to {displacement.max():.2f} {model.unit}")
    if out:
        softgrip.Log(t, pressure, displacement, unit=model.unit).write(out)


if __name__ == "__main__":
    main(*sys.argv[1:])
