"""One test as machines of many labs write it, and how it is read back."""

import json
from pathlib import Path

import numpy as np

from benchlab.io.machine_export import ExportOptions, MachineExport, export_document, read_machine_export

TIME_S = np.arange(12) / 10
EXTENSION_MM = np.round(0.5 * TIME_S**2 - 0.125, 5)
FORCE_N = np.round(2000 * np.sin(TIME_S) - 3.0625, 5)

# name: (names of time, extension, force, a word of the preamble, encodings that can write them)
LANGUAGES = {
    "english": ("Time", "Extension", "Load", "Specimen label", ("ascii", "utf-8", "utf-8-sig", "utf-16", "utf-16-le", "cp1252")),
    "german": ("Zeit", "Verlängerung", "Standardkraft", "Prüfgeschwindigkeit", ("utf-8", "utf-8-sig", "utf-16", "cp1252")),
    "polish": ("Godzina", "Wydłużenie", "Obciążenie", "Długość próbki", ("utf-8", "utf-16-le", "cp1250", "iso8859-2")),
    "spanish": ("Tiempo", "Extensión", "Carga", "Número de máquina", ("utf-8-sig", "cp1252", "mac_roman")),
    "french": ("Temps", "Déplacement", "Charge", "Éprouvette", ("utf-8", "cp1252")),
    "chinese": ("时间", "位移", "力", "试样", ("utf-8", "utf-16", "gbk")),
    "taiwanese": ("時間", "位移", "荷重", "編號", ("utf-8", "big5")),
    "japanese": ("時間", "変位", "試験力", "試料", ("utf-8", "cp932")),
    "korean": ("시간", "변위", "하중", "시편", ("utf-8", "cp949")),
    "russian": ("Время", "Перемещение", "Нагрузка", "Образец", ("utf-8", "cp1251")),
}  # fmt: skip
UNITS = {
    "N": 1.0,
    "kN": 1e3,
    "lbf": 4.4482216152605,
    "kgf": 9.80665,
    "gf": 9.80665e-3,
}  # N; lbf: 0.45359237 kg x 9.80665 m/s²
LENGTHS = {"mm": 1.0, "in": 25.4, "cm": 10.0}


def recording(
    language: str = "english",
    separator: str = ",",
    decimal: str = ".",
    quote: str = "",
    units: str = "row",
    force: str = "N",
    length: str = "mm",
    preamble: bool = True,
) -> str:
    """The test as a machine writes it. units: in a row of their own, in the header, or none."""
    names, known = LANGUAGES[language][:3], ("s", length, force)

    def cell(value: float) -> str:
        return quote + f"{value:.9f}".replace(".", decimal) + quote

    lines = (
        [f"{LANGUAGES[language][3]}{separator}A1", f"Rate{separator}{cell(5)}{separator}mm/min", ""] if preamble else []
    )
    lines.append(separator.join(f"{n} ({u})" if units == "header" else n for n, u in zip(names, known)))
    lines += [separator.join(f"({u})" for u in known)] if units == "row" else []
    columns = (TIME_S, EXTENSION_MM / LENGTHS[length], FORCE_N / UNITS[force])
    lines += [separator.join(map(cell, row)) for row in zip(*columns)]
    return "\n".join(lines) + "\n"


def read(path: Path, text: str, options: ExportOptions | None = None, encoding: str = "utf-8") -> MachineExport:
    path.write_bytes(text.encode(encoding))
    return read_machine_export(path, options)


def check(export: MachineExport) -> None:
    (test,) = export.tests
    assert tuple(test.columns) == ("time_s", "extension_mm", "force_N")
    for name, truth in zip(test.columns, (TIME_S, EXTENSION_MM, FORCE_N)):
        np.testing.assert_allclose(test.columns[name], truth, rtol=1e-9, atol=1e-6)
    json.dumps(export_document(export), allow_nan=False)
