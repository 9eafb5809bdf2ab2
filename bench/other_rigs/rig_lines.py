"""Air and oil lines of the simulated rigs."""
import numpy as np


def orifice_regulator(command, step_s, gain_per_s, fill, vent, supply, leak_per_s=0.0):
    """Returns the pressure [kPa] of a volume behind a proportional valve. `fill` and `vent` limit the rate of the pressure
    [kPa/s per square root of kPa], because the flow of an orifice is proportional to the root of the pressure difference."""
    state, out = float(command[0]), []
    for kpa in command.tolist():
        wanted = gain_per_s * (kpa - state)
        if wanted > 0:
            rate = min(wanted, fill * max(supply - state, 0.0) ** 0.5)
        else:
            rate = max(wanted, -vent * max(state + 2, 0.0) ** 0.5)
        state += (rate - leak_per_s * state) * step_s
        out.append(state)
    return np.array(out)


def integrating_regulator(command, step_s, proportional, integral, most_rate, limit=np.inf, leak_per_s=0.0, band=0.0):
    """Returns the pressure of a volume with a PI regulator, whose valve limits the flow. The volume loses leak_per_s of its
    pressure. The spool of the valve ignores changes of its command below `band`."""
    state, total, spool, out = float(command[0]), 0.0, 0.0, []
    for kpa in command.tolist():
        error = kpa - state
        wanted = proportional * error + total
        if abs(wanted) < most_rate:
            total += integral * error * step_s
        wanted = min(max(wanted, -most_rate), most_rate)
        if abs(wanted - spool) > band:
            spool = wanted
        rate = spool if state < limit or spool < 0 else 0.0
        state += (rate - leak_per_s * state) * step_s
        out.append(state)
    return np.array(out)
