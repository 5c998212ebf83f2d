"""Data sets that textbooks and R's documentation give with their results."""

from benchlab.stats.groups import Group, groups_of
from benchlab.stats.measurements import Measurements, measurements_of

PLANT_GROWTH = {
    "ctrl": "4.17 5.58 5.18 6.11 4.50 4.61 5.17 4.53 5.33 5.14",
    "trt1": "4.81 4.17 4.41 3.59 5.87 3.83 6.03 4.89 4.32 4.69",
    "trt2": "6.31 5.12 5.54 5.50 5.37 5.29 4.92 6.15 5.80 5.26",
}
WARP_BREAKS = {  # breaks ~ tension, both wools
    "L": "26 30 54 25 70 52 51 26 67 27 14 29 19 29 31 41 20 44",
    "M": "18 21 29 17 12 18 35 30 36 42 26 19 16 39 28 21 39 29",
    "H": "36 21 24 18 10 43 28 15 26 20 21 24 17 13 15 15 16 28",
}
INSECT_SPRAYS = {
    "A": "10 7 20 14 14 12 10 23 17 20 14 13",
    "B": "11 17 21 11 16 14 17 17 19 21 7 13",
    "C": "0 1 7 2 3 1 2 1 3 0 1 4",
    "D": "3 5 12 6 4 3 5 5 5 5 2 4",
    "E": "3 5 3 5 3 6 1 1 3 2 6 4",
    "F": "11 9 15 22 15 16 13 10 26 26 24 13",
}
MOSQUITO_WINGS = {
    # Sokal & Rohlf, Biometry, Box 10.1: left wings of mosquitoes, two measurements of each of four females in each of three cages.
    "cage 1": {"f1": "58.5 59.5", "f2": "77.8 80.9", "f3": "84.0 83.6", "f4": "70.1 68.3"},
    "cage 2": {"f1": "69.8 69.8", "f2": "56.0 54.5", "f3": "50.7 49.3", "f4": "63.8 65.8"},
    "cage 3": {"f1": "56.6 57.5", "f2": "77.8 79.2", "f3": "69.9 69.2", "f4": "62.1 64.5"},
}
GLUCOSE = {
    # ASTM E691, glucose in serum: four materials, a row a laboratory, three test results in each.
    "A": "41.03 41.45 41.37/41.17 42.00 41.15/41.01 40.68 42.66/39.37 42.37 42.63/41.88 41.19 41.32/43.28 40.50 42.28/"
    "41.08 41.27 39.02/43.36 42.65 41.72",
    "B": "78.28 78.18 78.49/77.78 80.38 79.54/79.18 79.72 80.81/84.08 78.60 81.92/78.16 79.58 78.33/78.66 79.27 81.75/"
    "79.76 81.45 77.35/80.44 80.80 79.80",
    "D": "193.71 193.59 193.65/190.88 200.14 194.30/192.71 193.28 190.28/195.85 196.36 199.43/192.59 191.44 195.12/"
    "195.34 198.26 198.13/194.66 191.99 187.13/197.56 195.99 200.82",
    "E": "292.78 294.09 292.89/292.27 309.40 295.08/295.53 290.14 292.34/295.19 295.44 296.83/293.93 292.48 294.28/"
    "297.74 296.80 290.33/287.29 293.76 289.36/298.46 295.28 296.12",
}


def measured(data: dict[str, str]) -> Measurements:
    """Each value a sample."""
    rows = [(name, value) for name, values in data.items() for value in values.split()]
    groups, values = zip(*rows)
    return measurements_of(groups, values)


def grouped(data: dict[str, str]) -> tuple[Group, ...]:
    return groups_of(measured(data))


def nested(data: dict[str, dict[str, str]]) -> Measurements:
    """Each value a cycle of a sample of a group."""
    rows = [(g, s, v) for g, samples in data.items() for s, values in samples.items() for v in values.split()]
    groups, samples, values = zip(*rows)
    return measurements_of(groups, values, samples)


def glucose() -> Measurements:
    return nested({m: {f"lab {i}": row for i, row in enumerate(rows.split("/"), 1)} for m, rows in GLUCOSE.items()})
