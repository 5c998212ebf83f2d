"""Protocol files: what is read, what every segment becomes, and what is refused with its line, key and remedy."""

import re
from pathlib import Path

import numpy as np
import pytest

from benchlab.errors import InputError, UsageError
from benchlab.io.protocol_file import protocol_text, read_protocol, shipped_protocols
from benchlab.protocol.plan import Control
from tests.pace import best_cpu_s, slowness

HEAD = "title: trial\nlimit_MPa: 0.35\nsegments:\n"


def write(folder: Path, text: str | bytes) -> Path:
    path = folder / "a.yaml"
    path.write_bytes(text if isinstance(text, bytes) else text.encode())
    return path


def refused(folder: Path, text: str | bytes, **options: float) -> str:
    with pytest.raises(InputError) as caught:
        read_protocol(write(folder, text), **options)
    line = str(caught.value)
    assert caught.value.exit_code == 3 and "\n" not in line and "a.yaml" in line
    return line


def of(*segments: str) -> str:
    return HEAD + "".join(f"  - {segment}\n" for segment in segments)


def test_a_file_becomes_a_plan(tmp_path: Path) -> None:
    text = """title: whole
about: for tests
limit_MPa: 0.3
rate_Hz: 50
control: {kp_MPa_per_deg: 1e-3, ki_MPa_per_deg_s: 0.01, feed_forward: true, lead_s: 0.2}
segments:
  - trigger: camera
  - repeat:
      times: 2
      segments:
        - ramp: {to_MPa: 0.2, duration_s: 1}
        - steps: {levels_MPa: [0.1, 0.3], hold_s: 1, rest_s: 0.5}
  - curvature: {hold: {angle_deg: 40, duration_s: 1}}
  - vent: {duration_s: 1}
"""
    plan = read_protocol(write(tmp_path, text))
    assert (plan.title, plan.about, plan.rate_Hz, plan.limit_MPa) == ("whole", "for tests", 50.0, 0.3)
    assert plan.control == Control(0.001, 0.01, True, 0.2)
    assert plan.duration_s == 10.0 and len(plan.time_s) == 501
    assert [step.line for step in plan.steps] == [11, 12, 12, 12, 12] * 2 + [13, 14]
    assert [step.kind for step in plan.steps[:5]] == ["ramp", "hold", "vent", "hold", "vent"]
    assert plan.steps[5].counts == (2,)
    assert read_protocol(write(tmp_path, text), rate_Hz=100).rate_Hz == 100


def test_encodings_and_line_ends_of_editors(tmp_path: Path) -> None:  # row 99
    text = of("hold: {pressure_MPa: 1e-1, duration_s: 1e0}")
    plans = [
        read_protocol(write(tmp_path, form))
        for form in (text, "\ufeff" + text, text.replace("\n", "\r\n"), text.encode("utf-16"))
    ]
    for plan in plans:
        np.testing.assert_array_equal(plan.pressure_MPa, np.full(101, 0.1))  # row 92: 1e-1 is a number


RAMP = "ramp: {to_MPa: 0.3, duration_s: 2}"


@pytest.mark.parametrize(
    ("text", "words"),
    [
        pytest.param(of("!!python/object/apply:os.system ['touch /tmp/owned']"), ["line 4", "not YAML"], id="88"),
        pytest.param("a: &a [x]\nb: *a\n" + HEAD, ["line 1", "anchors and aliases"], id="89"),
        pytest.param(of("hold: " + "[" * 5000), ["line 4", "nested deeper"], id="90"),
        pytest.param(of("repeat: {times: 2, segments: [{" * 30), ["nested deeper"], id="90-repeats"),
        pytest.param(
            of(RAMP) + "limit_MPa: 0.3\n", ["line 5", "duplicate key limit_MPa", "already on line 2"], id="91"
        ),
        pytest.param(
            of("ramp: {to_MPa: 0.1, to_MPa: 0.3, duration_s: 2}"), ["line 4", "duplicate key", "to_MPa"], id="91-inline"
        ),
        pytest.param(of("ramp: {to_MPa: no, duration_s: 2}"), ["line 4", 'to_MPa is "no"', "number"], id="93-no"),
        pytest.param(of("ramp: {to_MPa: 0.1, duration_s: 1:30}"), ["line 4", 'duration_s is "1:30"'], id="93-time"),
        pytest.param(
            of("hold: {pressue_MPa: 0.1, duration_s: 1}"),
            ["line 4", "unknown key", "did you mean pressure_MPa?"],
            id="94",
        ),
        pytest.param(
            of("ramp: {to_MPa: 0.9, duration_s: 2}"), ["line 4", "reaches 0.9 MPa, above limit_MPa 0.35"], id="95-limit"
        ),
        pytest.param(of("ramp: {to_MPa: 900, duration_s: 2}"), ["line 4", "to_MPa is 900", "write 0.9"], id="95-kPa"),
        pytest.param(
            of("ramp: {to_MPa: .nan, duration_s: .inf}"), ["line 4", "to_MPa is nan", "duration_s is inf"], id="95-nan"
        ),
        pytest.param(of("ramp: {to_MPa: 1e999, duration_s: 1}"), ["line 4", "to_MPa is inf", "finite"], id="95-1e999"),
        pytest.param(
            of("ramp: {to_MPa: 0.1, rate_MPa_per_s: 0}"),
            ["line 4", "rate_MPa_per_s is 0", "more than 0"],
            id="96-rate",
        ),
        pytest.param(
            of("ramp: {to_MPa: 0.1, rate_MPa_per_s: -1}"), ["line 4", "rate_MPa_per_s is -1"], id="96-negative"
        ),
        pytest.param(of("hold: {duration_s: -1}"), ["line 4", "duration_s is -1", "more than 0"], id="96-hold"),
        pytest.param(
            HEAD.replace("segments:", "segments: []"), ["line 3", "segments is []", "at least 1 item"], id="96-empty"
        ),
        pytest.param(of("repeat: {times: 0, segments: [{vent: {duration_s: 1}}]}"), ["times is 0"], id="96-times"),
        pytest.param(of("repeat: {times: 2, segments: []}"), ["segments is []", "at least 1 item"], id="96-nothing"),
        pytest.param(
            of("triangle: {low_MPa: 0, high_MPa: 0.1, rate_MPa_per_s: 1, cycles: 1.5}"),
            ["cycles is 1.5", "whole number"],
            id="96-half",
        ),
        pytest.param(
            of("ramp: {to: 10 psi, duration_s: 1}"), ["line 4", "unknown key", "write to_MPa: 0.0689"], id="97-psi"
        ),
        pytest.param(of("ramp: {to_kPa: 35, duration_s: 1}"), ["line 4", "write to_MPa: 0.035"], id="97-kPa"),
        pytest.param(
            of("ramp: {to_MPa: 350 kPa, duration_s: 1}"), ['to_MPa is "350 kPa"', "write to_MPa: 0.35"], id="97-value"
        ),
        pytest.param(of("ramp: {to_MPa: 0.1, duration: 2 min}"), ["write duration_s: 120"], id="97-min"),
        pytest.param(of("ramp: {to_MPa: 0.1, rate_kPa_per_s: 20}"), ["write rate_MPa_per_s: 0.02"], id="97-rate"),
        pytest.param(of("curvature: {hold: {angle_rad: 1, duration_s: 1}}"), ["write angle_deg: 57.3"], id="97-rad"),
        pytest.param(of("ramp: {to: 0.1, duration_s: 1}"), ["did you mean to_MPa or to_deg?"], id="97-none"),
        pytest.param(of("\tvent: {duration_s: 1}"), ["line 4", "not YAML"], id="99-tab"),
        pytest.param(b"title: \xff\xfe", ["UTF-8"], id="99-bytes"),
        pytest.param(
            of("include: ../../etc/passwd"), ["line 4", "unknown key segments[0].include", "remove it"], id="100"
        ),
        pytest.param("include: a.yaml\n" + of(RAMP), ["line 1", "unknown key include"], id="100-itself"),
        pytest.param(of("!include ../../etc/passwd"), ["line 4"], id="100-tag"),
    ],
)
def test_bad_inputs_are_refused_with_line_and_remedy(tmp_path: Path, text: str | bytes, words: list[str]) -> None:
    line = refused(tmp_path, text)
    for word in words:
        assert word in line
    assert not Path("/tmp/owned").exists()


def test_octal_is_a_decimal_number(tmp_path: Path) -> None:  # row 93: `010` is 10, as YAML 1.2 has it
    assert read_protocol(write(tmp_path, of("hold: {duration_s: 010}"))).duration_s == 10


def test_everything_that_is_wrong_is_said_at_once_in_the_order_of_lines(tmp_path: Path) -> None:
    text = of("ramp: {to: 10 psi, duration_s: 0}", "hold: {duration_s: .nan}", "rmap: {}", "vent") + "rate_Hz: 0\n"
    line = refused(tmp_path, text)
    assert line.startswith(f"{tmp_path / 'a.yaml'}: 6 things are wrong: line 4: ")
    places = [int(number) for number in re.findall(r"line (\d+): ", line)]
    assert places == [4, 4, 5, 6, 7, 8]
    assert "missing" not in line  # `to` is told once, as the key that it should have been


def test_what_segments_say_of_each_other_is_said_at_once_too(tmp_path: Path) -> None:
    line = refused(
        tmp_path,
        of("ramp: {to_MPa: 0.4, duration_s: 1}", "triangle: {low_MPa: 0, high_MPa: 0.5, rate_MPa_per_s: 1, cycles: 1}"),
    )
    assert "2 things are wrong: line 4: ramp 0 to 0.4 MPa in 1 s reaches 0.4 MPa" in line
    assert "line 5: the triangle starts at 0 MPa and the present pressure is 0.4 MPa (write a vent before it)" in line


@pytest.mark.parametrize(
    ("segment", "words"),
    [
        ("ramp: {to_MPa: 0.1}", "give either duration_s or rate_MPa_per_s"),
        ("ramp: {to_MPa: 0.1, duration_s: 1, rate_MPa_per_s: 1}", "give either duration_s or rate_MPa_per_s"),
        ("ramp:", "write what belongs to `ramp:`"),
        ("{vent: {duration_s: 1}, hold: {duration_s: 1}}", "write one segment as"),
        ("vent", "write one segment as"),
        ("[vent, 1]", "write one segment as"),
        ("mark: ''", "mark is"),
        ("mark: 3", "mark is 3"),
        ("trigger: light", "'camera'"),
        (
            "curvature: {hold: {angle_deg: 9, duration_s: 1}, ramp: {to_deg: 9, duration_s: 1}}",
            "exactly one of hold, ramp, sine",
        ),
        ("curvature: {}", "exactly one of hold, ramp, sine"),
        ("curvature: {hold: {angle_deg: 400, duration_s: 1}}", "360 or less"),
        ("steps: {hold_s: 1}", "give either levels_MPa, or from_MPa, to_MPa and step_MPa"),
        ("steps: {hold_s: 1, from_MPa: 0, to_MPa: 0.1}", "give from_MPa, to_MPa and step_MPa together"),
        ("steps: {hold_s: 1, levels_MPa: [0.1], step_MPa: 0.1}", "give either levels_MPa, or"),
        ("steps: {hold_s: 1, from_MPa: 0, to_MPa: 0.35, step_MPa: 0.1}", "do not end at 0.35 MPa"),
        ("steps: {hold_s: 1, from_MPa: 0, to_MPa: 0.35, step_MPa: 1e-12}", "100,000 are the most"),
        ("steps: {hold_s: 1, levels_MPa: [0.1], cycles: 2}", "give rest_s"),
        ("triangle: {low_MPa: 0.2, high_MPa: 0.1, rate_MPa_per_s: 1, cycles: 1}", "high_MPa above low_MPa"),
        ("sine: {mean_MPa: 0.1, amplitude_MPa: 0, frequency_Hz: 1, cycles: 1}", "more than 0"),
        ("hold: {pressure_MPa: -0.1, duration_s: 1}", "0 or more"),
        ("hold: {pressure_MPa: true, duration_s: 1}", "pressure_MPa is true"),
        ("hold: {pressure_MPa: '0.1', duration_s: 1}", "number"),
    ],
)
def test_impossible_segments_are_refused(tmp_path: Path, segment: str, words: str) -> None:
    line = refused(tmp_path, of(segment))
    assert words in line and "line 4" in line


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        ("limit_MPa: 0.35\n", "", "limit_MPa is missing"),
        ("limit_MPa: 0.35", "limit_kPa: 350", "write limit_MPa: 0.35"),
        ("limit_MPa: 0.35", "limit_MPa: 0", "more than 0"),
        ("title: trial", "title: ''", "a line of up to 200 letters"),
        ("title: trial", "title: trial\nrate_Hz: 501", "500 or less"),
        (
            "title: trial",
            "title: trial\ncontrol: {kp_MPa_per_deg: 1, ki_MPa_per_deg_s: 1}",
            "line 2: control is given, and no segment",
        ),
        ("title: trial", "title: trial\nslew_limit_MPa_per_s: 0.1", "0.15 MPa/s, above slew_limit_MPa_per_s 0.1"),
    ],
)
def test_impossible_heads_are_refused(tmp_path: Path, old: str, new: str, words: str) -> None:
    assert words in refused(tmp_path, of(RAMP).replace(old, new))


def test_a_million_steps_are_refused_before_they_are_unrolled(tmp_path: Path) -> None:  # row 98
    text = of(
        "repeat: {times: 500000, segments: [{hold: {pressure_MPa: 0.1, duration_s: 1}}, {vent: {duration_s: 1}}]}"
    )
    assert best_cpu_s(lambda: refused(tmp_path, text)) < 0.5 * slowness()
    line = refused(tmp_path, text)
    assert (
        "would last 1000000 s (11 d 13 h 47 min), more than 3600 s (shorten it, or allow it with --max-duration-s)"
        in line
    )
    assert "1e+08 ticks" in line and "would be 1000000 steps" in line
    allowed = refused(tmp_path, text, max_duration_s=2e6)
    assert "would last" not in allowed and "100,000 are the most" in allowed
    nested = "{vent: {duration_s: 1}}"
    for _ in range(8):
        nested = f"{{repeat: {{times: 1000000000, segments: [{nested}]}}}}"
    assert "would last 1e+72 s" in refused(tmp_path, of(nested))


def test_a_huge_file_is_refused_before_it_is_parsed(tmp_path: Path) -> None:
    text = of(*["vent: {duration_s: 1}"] * 20_000)
    assert best_cpu_s(lambda: refused(tmp_path, text)) < 0.5 * slowness()
    assert "0.25 MB for a protocol; write what comes again as `repeat`" in refused(tmp_path, text)


def test_a_longer_protocol_may_be_allowed(tmp_path: Path) -> None:
    path = write(tmp_path, of("hold: {pressure_MPa: 0.1, duration_s: 3601}"))
    with pytest.raises(InputError, match=r"would last 3601 s \(1 h\)"):
        read_protocol(path)
    assert read_protocol(path, max_duration_s=4000).duration_s == 3601


def test_what_is_no_file_and_no_name_is_refused_with_the_names(tmp_path: Path) -> None:
    with pytest.raises(UsageError, match=r"give a file, or one of blocked_force_steps.*sine_tracking"):
        read_protocol("nothing")
    with pytest.raises(UsageError, match=r"did you mean linear_ramp\?"):
        read_protocol("linear_rampe")
    with pytest.raises(UsageError, match="no such file"):
        read_protocol(tmp_path / "none.yaml")
    with pytest.raises(UsageError, match="is a folder"):
        read_protocol(tmp_path)
    for option in (
        {"max_duration_s": float("nan")},
        {"rate_Hz": float("inf")},
        {"rate_Hz": 0.0},
        {"max_duration_s": -1.0},
    ):
        with pytest.raises(UsageError, match="give"):
            read_protocol("linear_ramp", **option)


def test_the_text_of_a_protocol_is_kept_as_it_is() -> None:
    for name, path in shipped_protocols().items():
        assert protocol_text(name) == path.read_text(encoding="utf-8") == protocol_text(path)


def test_the_examples_of_the_guide_are_read(tmp_path: Path) -> None:
    guide = Path(__file__).resolve().parents[3] / "docs" / "protocols.md"
    examples = re.findall(r"```yaml\n(.*?)```", guide.read_text(encoding="utf-8"), re.DOTALL)
    assert len(examples) >= 8
    for example in examples:
        whole = example if "title:" in example else "title: example\nlimit_MPa: 0.35\n" + example
        assert read_protocol(write(tmp_path, whole)).duration_s > 0
    kinds = set(re.findall(r"- (\w+):", "".join(examples))) | set(re.findall(r"\{(\w+): \{", "".join(examples)))
    from benchlab.io.protocol_schema import ProtocolDocument, SegmentDocument

    assert set(SegmentDocument.model_fields) <= kinds
    for key in ProtocolDocument.model_fields:
        assert f"`{key}`" in guide.read_text(encoding="utf-8")
