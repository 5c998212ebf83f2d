"""What testing machines call their columns, in the languages of the labs: the one list that finds columns and tells encodings."""

from __future__ import annotations

COLUMN_WORDS: dict[str, tuple[str, ...]] = {
    "time": (
        *("time", "t", "elapsed time", "total time", "test time", "running time", "timestamp"),
        *("zeit", "prüfzeit", "laufzeit", "testzeit"),
        *("czas", "godzina", "temps", "tiempo", "tempo", "tijd", "tid", "čas", "idő", "время", "zaman"),
        *("时间", "時間", "시간"),
    ),
    "extension": (
        *("extension", "displacement", "crosshead", "crosshead displacement", "crosshead extension", "crosshead position"),
        *("position", "stroke", "crosshead travel", "tensile extension", "compressive extension", "flexure extension"),
        *("tensile displacement", "compressive displacement", "flexure displacement"),
        *("traversenweg", "traverse", "weg", "standardweg", "verlängerung", "verschiebung", "dehnweg", "auszug"),
        *("przemieszczenie", "wydłużenie", "droga", "prodloužení", "posuv", "elmozdulás"),
        *("extensión", "desplazamiento", "déplacement", "allongement", "course", "spostamento", "estensione", "corsa"),
        *("extensão", "deslocamento", "verplaatsing", "перемещение", "удлинение", "uzama"),
        *("位移", "伸长", "行程", "变形", "位移量", "変位", "ストローク", "伸び", "변위", "신율"),
    ),
    "force": (
        *("force", "load", "tensile load", "compressive load", "flexure load", "tensile force", "compressive force"),
        *("flexure force", "standard force", "load cell", "axial force", "axial load"),
        *("last", "kraft", "standardkraft", "prüfkraft", "zugkraft", "druckkraft", "biegekraft"),
        *("obciążenie", "siła", "siła standardowa", "síla", "zatížení", "erő", "terhelés"),
        *("carga", "fuerza", "effort", "charge", "forza", "carico", "força", "kracht", "belasting", "нагрузка", "сила", "kuvvet", "yük"),
        *("力", "载荷", "负荷", "负载", "力值", "試験力", "荷重", "하중", "힘"),
    ),
    "pressure": (
        *("pressure", "p", "supply pressure", "air pressure", "internal pressure", "gauge pressure"),
        *("druck", "ciśnienie", "presión", "pression", "pressione", "pressão", "druk", "tlak", "nyomás", "давление", "basınç"),
        *("压力", "气压", "压强", "圧力", "압력"),
    ),
    "cycle": (
        *("cycle", "cycles", "total cycle count", "cycle count", "total cycles", "elapsed cycles", "cycle number", "cycle elapsed count"),
        *("zyklus", "zyklen", "cykl", "cykle", "ciclo", "ciclos", "cicli", "nombre de cycles"),
        *("循环", "循环数", "循环次数", "サイクル"),
    ),
    "segment": (
        *("segment", "segment id", "segment number", "step", "phase", "schritt", "abschnitt", "krok", "segmento", "paso", "étape"),
        *("段", "阶段"),
    ),
    "specimen": (
        *("specimen", "specimen id", "specimen no", "specimen number", "specimen name", "specimen label", "test specimen"),
        *("probe", "probekörper", "proben-nr", "próbka", "numer próbki", "probeta", "éprouvette", "provino", "corpo de prova"),
        *("vzorek", "образец", "numune", "试样", "试样编号", "試験片", "시편"),
    ),
}  # fmt: skip
"""Names of columns in lower case, by what they hold."""

PREAMBLE_WORDS = (
    *("prüfung", "länge", "höhe", "breite", "größe", "prüfgeschwindigkeit", "querschnitt", "beschriftung", "für", "müller"),
    *("właściwości", "próbki", "długość", "szerokość", "grubość", "odkształcenie", "rozciąganiu", "naprężenie", "średnica"),
    *("prędkość", "początkowa", "maksymalne", "zmęczenie", "próba", "wysokość", "pomiarowa"),
    *("deformación", "tracción", "elongación", "número", "máximo", "máxima", "tensión", "sección", "área", "opción", "numéricas"),
    *("separación", "identificador único", "geometría", "compresión", "diámetro", "descripción", "método"),
    *("éprouvette", "contrainte", "déformation", "épaisseur", "vitesse d'essai", "numéro", "résultats", "échantillon", "diamètre"),
    *("velocità", "diametro", "deformação", "tensão", "número do", "máxima", "amostra", "secção", "seção"),
    *("vzorek", "průměr", "tloušťka", "šířka", "délka", "napětí", "rychlost", "sebesség", "vastagság", "szélesség"),
    *("试样", "应力", "应变", "速度", "宽度", "厚度", "长度", "标距", "编号", "最大", "试验", "结果", "日期", "样品"),
    *("試験", "応力", "ひずみ", "速度", "試料", "幅", "厚さ", "시편", "응력", "변형률", "두께", "образец", "напряжение", "ширина"),
    *("deformação", "ø", "°c", "mm²", "mm³", "µm", "±"),
)  # fmt: skip
"""Words of preambles, in lower case, that tell one encoding from another."""
