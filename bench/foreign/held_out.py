"""Reads logs as arrays. Defines how a model of another program is tested on a part of a log to which the model was not
fitted."""
import numpy as np

# The first 5 % of a log, but at least 2 s, may be used to estimate the offset and the initial state of the log.
START_SHARE, START_S = 0.05, 2.0


def read(path):
    """Returns time [s], input [kPa] and reading [mm] of a log. The input is the measured pressure if the log contains a
    measured pressure, otherwise the command."""
    data = np.genfromtxt(path, delimiter=",", names=True)
    drive = data["pressure_kpa"] if "pressure_kpa" in data.dtype.names else data["pressure_command_kpa"]
    known = np.isfinite(drive)
    drive = np.interp(data["time_s"], data["time_s"][known], drive[known])
    return [np.ascontiguousarray(values, dtype=float) for values in (data["time_s"], drive, data["displacement_mm"])]


def first_share(time, share):
    """Returns a mask that selects the first `share` of the samples of a log."""
    return np.arange(len(time)) < int(share * len(time))


def rmse(error):
    return float(np.sqrt(np.nanmean(error * error)))


def beginning(time):
    """Returns a mask that selects the samples from which the offset and the initial state of a log may be estimated."""
    return time - time[0] <= max(START_SHARE * (time[-1] - time[0]), START_S)


def rmse_with_own_offset(time, simulated, reading):
    """Returns the RMSE on a log that was not fitted. The mean error at the beginning of the log is subtracted first."""
    error = simulated - reading
    return rmse(error - np.nanmean(error[beginning(time)]))
