"""Defines the common units of measured columns, and their conversion to the units of the log format."""
import re

TIME_POINT = "datetime"  # unit of a column that contains dates with times of day (ISO 8601)

# for each quantity: unit in lower case -> units of the log format (s, kPa, mm) per unit
QUANTITIES = {
    "time": {"s": 1, "sec": 1, "ms": 1e-3, "us": 1e-6, "µs": 1e-6, "ns": 1e-9, "min": 60, "h": 3600, TIME_POINT: 1},
    "pressure": {"kpa": 1, "pa": 1e-3, "hpa": 0.1, "mpa": 1000, "bar": 100, "mbar": 0.1, "psi": 6.894757,
                 "psig": 6.894757, "atm": 101.325, "mmhg": 0.1333224, "torr": 0.1333224},
    "displacement": {"mm": 1, "cm": 10, "m": 1000, "um": 1e-3, "µm": 1e-3, "in": 25.4, "inch": 25.4},
    "temperature": {"c": 1, "degc": 1, "°c": 1, "k": 1, "f": 5 / 9, "degf": 5 / 9, "°f": 5 / 9},
}
# The temperature of 0 degrees Celsius in each unit of temperature.
ZEROS = {"k": 273.15, "f": 32, "degf": 32, "°f": 32}


def units_of(quantity):
    return ", ".join(QUANTITIES[quantity])


def unit_in(name, quantity):
    """Returns the unit in a column's name, as in pd1_psi, "p [bar]" or "Time (ms)"; empty if the name has no known unit."""
    for pattern in (r"[\[(]\s*([^\])]+?)\s*[\])]\s*$", r"[_\s./]([A-Za-zµ°]+)\s*$"):
        found = re.search(pattern, str(name))
        if found and found.group(1).lower() in QUANTITIES[quantity]:
            return found.group(1).lower()
    return ""
