"""Inverts the model of a finger and prints the tracking error of a simulation. Usage: invert_finger.py MODEL.yaml"""

import sys

import numpy as np

import softgrip


def main(model_file: str) -> None:
    model = softgrip.Model.load(model_file)
    t = np.arange(0, 20, 0.005)
    wanted = 6 - 2 * np.cos(0.2 * np.pi * t)
    command = model.inverse(t, wanted, pressure_max=80)
    moved = model.simulate(t, command.pressure_kpa, held=True)  # holds each command, as a board does
    error = np.abs(moved - wanted)[t > 3]  # the finger needs some time to reach the first value of the sine
    print(f"largest command {command.pressure_kpa.max():.2f} kPa, largest error {error.max():.1e} {model.unit}")


if __name__ == "__main__":
    main(sys.argv[1])
