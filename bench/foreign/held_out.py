"""Logs as arrays, and the rule by which models that know nothing of softgrip predict a part that was not fitted."""
import numpy as np

START_SHARE, START_S = 0.05, 2.0  # the first 5 %, at least 2 s, of a log may estimate its offset and initial state


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
    """The samples that may estimate how a log begins, as a mask."""
    return time - time[0] <= max(START_SHARE * (time[-1] - time[0]), START_S)


def rmse_with_own_offset(time, simulated, reading):
    """RMSE on a log that was not fitted, after the mean error of its beginning is removed."""
    error = simulated - reading
    return rmse(error - np.nanmean(error[beginning(time)]))
