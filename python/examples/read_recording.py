"""Prints the largest pressure, the largest displacement and the holding time of each finger in a recording.

The holding time is the time for which the finger held its part.

    read_recording.py RECORDING
"""

import sys

import numpy as np

from softgrip.recordings import Recording


def main(folder: str) -> None:
    recording = Recording.read(folder)
    sequence = recording.about["sequence"]
    print(f"{sequence['name'] if sequence else 'no sequence'}, {recording.about['rate_hz']} Hz")
    for name, columns in recording.channels.items():
        held = columns["result"] == "holding"
        seconds = np.count_nonzero(held) * recording.about["decimation"] / recording.about["rate_hz"]
        print(f"{name}: at most {np.nanmax(columns['pressure_command_kpa']):.1f} kPa, "
              f"{np.nanmax(columns['displacement_mm']):.2f} mm, held for {seconds:.2f} s")


if __name__ == "__main__":
    main(sys.argv[1])
