"""Logs as arrays, and the rule by which models of other programs predict a part that was not fitted."""
import numpy as np

# The first 5 % of a log, at least 2 s, may be used to estimate its offset and initial state.
START_SHARE, START_S = 0.05, 2.0


def read(path):
    """(time [s], drive [kPa], reading [mm]); the measured pressure drives where the log has one."""
    data = np.genfromtxt(path, delimiter=",", names=True)
    drive = data["pressure_kpa"] if "pressure_kpa" in data.dtype.names else data["pressure_command_kpa"]
    known = np.isfinite(drive)
    drive = np.interp(data["time_s"], data["time_s"][known], drive[known])
    return [np.ascontiguousarray(values, dtype=float) for values in (data["time_s"], drive, data["displacement_mm"])]


def first_share(time, share):
    """The samples of the first `share` of a log, as a mask."""
    return np.arange(len(time)) < int(share * len(time))


def rmse(error):
    return float(np.sqrt(np.nanmean(error * error)))


def beginning(time):
    """The samples from which the offset and the initial state of a log may be estimated, as a mask."""
    return time - time[0] <= max(START_SHARE * (time[-1] - time[0]), START_S)


def rmse_with_own_offset(time, simulated, reading):
    """RMSE on a log that was not fitted, after subtracting the mean error of its beginning."""
    error = simulated - reading
    return rmse(error - np.nanmean(error[beginning(time)]))
