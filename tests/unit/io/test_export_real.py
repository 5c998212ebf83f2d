"""Exports of real machines. What each holds was taken from the files with grep and awk and, for the extremes, the csv module, not
with the reader: lines, numbers in the files' own units."""

from pathlib import Path

import numpy as np
import pytest

from benchlab.errors import InputError, UsageError
from benchlab.io.machine_export import ExportOptions, export_document, read_machine_export

LBF, KGF, INCH = 4.4482216152605, 9.80665, 25.4
LENGTH_FORCE = ("time_s", "extension_mm", "force_N")
CYCLIC = (*LENGTH_FORCE, "cycle", "segment")
# pattern: (rows, first line, last time, last extension, least force, largest force, encoding, separator, decimal, thousands, columns)
FILES = {
    "AS627*": (202, 28, 100, 6.67, -43.5, 22840, "ascii", "comma", "point", "none seen", LENGTH_FORCE),
    "Aschen*": (1983, 7, 197.88201, 3.2982, 85, 8517, "ascii", "semicolon", "comma", "none seen", LENGTH_FORCE),
    "Chongran*": (1007, 4, 20.083, -0.0002, -0.0153, 0.8766, "gbk", "comma", "point", "none seen", LENGTH_FORCE),
    "DVLevine*": (2257, 10, 225.502, 18.99003, 10.03282, 805.76984, "ascii", "comma", "point", "none seen", LENGTH_FORCE),
    "Follow*No_IDs*": (279, 12, 46.462, 0.45269, 499.71045, 3802.00708, "ascii", "comma", "point", "comma", LENGTH_FORCE),
    "Follow*Yield*": (1467, 12, 164.708, 2.4455, 462.37708, 15365.93555, "ascii", "comma", "point", "comma", LENGTH_FORCE),
    "Kelsey*charmin*": (222, 3, 21.926, 2.38013, -0.00675, 100.18766, "ascii", "comma", "point", "none seen", LENGTH_FORCE),
    "Kelsey*taco*": (465, 5, 43.715, 53.24432, 100.15324, 1274.44922, "ascii", "comma", "point", "comma", LENGTH_FORCE),
    "Nosh*": (5977, 7, 597.582, 1.50371 * INCH, 14.59236 * LBF, 131.18347 * LBF, "ascii", "comma", "point", "none seen", LENGTH_FORCE),
    "luk*": (460, 11, 44.694, 4.54199, 0.27211, 7746.60889, "cp1250", "semicolon", "comma", "none seen", LENGTH_FORCE),
    "mike*": (1475, 3, 29.479, 9.8205 * INCH, -0.0033 * LBF, 0.0805 * LBF, "ascii", "comma", "point", "none seen", LENGTH_FORCE),
    "yadbor*": (18011, 6, 360.06, -2.04555, -52.97507, 0.35677, "ascii", "comma", "point", "none seen", CYCLIC),
    "zeus*": (40625, 52, 4062.326, 338.53391, -0.00477 * KGF, 48.42204 * KGF, "cp1252", "comma", "point", "none seen", LENGTH_FORCE),
}  # fmt: skip


@pytest.mark.parametrize("pattern", FILES)
def test_exports(real_folder: Path, pattern: str) -> None:
    rows, first, time, extension, low, high, encoding, separator, decimal, thousands, columns = FILES[pattern]
    (path,) = (real_folder / "instron").glob(pattern)
    export = read_machine_export(path)
    (test,) = export.tests
    assert (export.rows, test.first_line, tuple(test.columns)) == (rows, first, columns)
    found = [test.columns[name][-1] for name in ("time_s", "extension_mm")] + [
        test.columns["force_N"].min(),
        test.columns["force_N"].max(),
    ]
    np.testing.assert_allclose(found, [time, extension, low, high], rtol=1e-12)
    said = [export.inferred[name] for name in ("encoding", "separator", "decimal", "thousands", "specimens")]
    assert said == [encoding, separator, decimal, thousands, "one"]
    assert all(np.isfinite(values).all() for values in test.columns.values())


def test_results_first_and_four_specimens(real_folder: Path) -> None:
    (path,) = (real_folder / "instron").glob("xjill*")
    export = read_machine_export(path)
    assert [(t.specimen, t.first_line, len(t.lines)) for t in export.tests] == [
        *(("1", 14, 83), ("2", 99, 98)),
        *(("3", 199, 91), ("4", 292, 99)),
    ]
    peaks = [t.columns["force_N"].max() for t in export.tests]
    assert peaks == [3196.2251, 3051.6743, 2886.5696, 2991.3896]  # as the file's own table of results has them
    assert export.tests[3].columns["extension_mm"][-1] == 1.3991
    assert export.inferred["extension_mm"] == "column 3, 'Displacement (mm)', in mm"
    assert "'Corrected displacement 1 (mm)'" in export.inferred["not used"]
    (warning,) = export.warnings
    assert warning.startswith("the table in line 4 (Digital Strain 1 gauge length, ")


def test_what_else_the_files_say(real_folder: Path) -> None:
    folder = real_folder / "instron"
    (polish,), (german,), (twice,) = (list(folder.glob(p)) for p in ("luk*", "Aschen*", "AS627*"))
    assert read_machine_export(polish).preamble["Właściwości próbki : Grubość"] == "2,46000 mm"
    assert read_machine_export(german).inferred["force_N"] == "column 3, 'Last (kN)', in kN"
    assert read_machine_export(twice).warnings == ("line 29: the time stands still, once",)
    assert export_document(read_machine_export(german))["sample_rate_Hz"] == pytest.approx(10)


def test_a_broken_capture_is_refused(real_folder: Path) -> None:
    (path,) = (real_folder / "instron").glob("aznxed*")
    with pytest.raises(InputError, match="line 1: no row of numbers: '4"):
        read_machine_export(path)


def test_actuators_without_header_need_names(real_folder: Path) -> None:
    (muscle,), (finger,) = ((real_folder / "actuators").glob(p) for p in ("Agile*", "TheBig*"))
    for path, count in ((muscle, 4), (finger, 3)):
        with pytest.raises(
            UsageError, match=f"{count} columns without names or units; name the columns by place, as --columns"
        ):
            read_machine_export(path)
    (test,) = read_machine_export(muscle, ExportOptions(columns="force_N,pressure_kPa,time_s,-")).tests
    assert len(test.lines) == 15_000 and tuple(test.columns) == ("time_s", "force_N", "pressure_MPa")
    assert (test.columns["force_N"].min(), test.columns["force_N"].max()) == (0.8277, 323.24)
    assert test.columns["pressure_MPa"].max() == pytest.approx(0.62662)
