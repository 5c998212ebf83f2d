"""What stands in the picture of a run."""

from __future__ import annotations

import numpy as np
import pytest

from benchlab.io.journal import read_journal
from benchlab.report.drive_figure import draw_drive_figure, end_words
from benchlab.report.figures import save_png
from tests.unit.io.journals import header_of, samples_of, write_journal

EVENTS = {
    0: [{"kind": "trigger", "tick": 0, "time_s": 0.0}, {"kind": "mark", "tick": 0, "time_s": 0.0, "text": "up $x_{$"}],
    200: [{"kind": "mark", "tick": 200, "time_s": 4.0, "text": "second"}],
}
STOPPED = {"reason": "not following", "words": "leak", "vented": False, "time_s": 5.0}


def journal(tmp_path, samples=None, kind="serial", **options):
    samples = samples_of() if samples is None else samples
    path = write_journal(tmp_path / "a.journal", samples, header_of(samples_of(), kind), EVENTS, **options)
    return read_journal(path)


def words(figure) -> list[str]:
    return [text.get_text() for text in (*figure.texts, *(text for ax in figure.axes for text in ax.texts))]


def labels(ax) -> list[str]:
    return [text.get_text() for text in ax.get_legend().get_texts()] if ax.get_legend() else []


def test_three_panels_with_the_numbers_of_the_run(tmp_path):
    figure = draw_drive_figure(journal(tmp_path))
    pressure, angle, loop = figure.axes
    lines = {line.get_label(): line for line in pressure.lines}
    np.testing.assert_array_equal(lines["asked for"].get_ydata(), samples_of()["command_MPa"])
    np.testing.assert_array_equal(lines["measured"].get_ydata(), samples_of()["pressure_MPa"])
    np.testing.assert_array_equal(angle.lines[0].get_ydata(), samples_of()["angle_deg"])
    assert labels(angle) == ["by the flex sensor"]
    assert labels(loop) == ["cycle 2", "cycle 1"]
    first = loop.lines[1]
    np.testing.assert_array_equal(first.get_xdata(), samples_of()["pressure_MPa"])
    assert np.isfinite(first.get_ydata()).sum() == 200
    assert [ax.get_xlabel() for ax in figure.axes] == ["", "time (s)", "pressure measured (MPa)"]


def test_marks_are_told_once_and_those_of_one_moment_together(tmp_path):
    figure = draw_drive_figure(journal(tmp_path))
    assert [text.get_text() for text in figure.axes[0].texts] == ["camera, up $x_{$", "second"]
    assert [text.get_text() for text in figure.axes[1].texts] == []


def test_the_title_says_what_is_simulated_and_the_line_below_how_it_ended(tmp_path):
    told = words(draw_drive_figure(journal(tmp_path, kind="twin", stop=STOPPED)))
    assert told[0] == "Two triangles: simulated (twin)"
    assert told[1] == "400 samples; 1 trigger of the camera; not following: leak; NOT CONFIRMED VENTED"
    assert "not following" in told[2:]


def test_a_run_without_its_end_says_so_and_what_is_lost(tmp_path):
    journal(tmp_path)
    path = tmp_path / "a.journal"
    path.write_bytes(path.read_bytes()[:-70])
    told = end_words(read_journal(path))
    assert "no record of its end" in told and "vented is not known" in told and "the last record is cut" in told


def test_what_was_not_measured_has_no_panel(tmp_path):
    samples = samples_of()
    samples["angle_deg"] = np.nan
    assert len(draw_drive_figure(journal(tmp_path, samples)).axes) == 1
    samples["pressure_MPa"] = np.nan
    (tmp_path / "a.journal").unlink()
    (ax,) = draw_drive_figure(journal(tmp_path, samples)).axes
    assert labels(ax) == ["asked for", "not measured"]


def test_closed_loop_shows_what_was_asked_for(tmp_path):
    _, angle, _ = draw_drive_figure(journal(tmp_path, samples_of(closed_loop=True))).axes
    assert labels(angle) == ["asked for", "by the flex sensor"]


def test_no_line_goes_across_a_hole_and_the_words_tell_it(tmp_path):
    holed = journal(tmp_path, np.delete(samples_of(), np.r_[120:170]))
    figure = draw_drive_figure(holed)
    for line in (*figure.axes[0].lines[:2], figure.axes[1].lines[0]):
        x, y = line.get_data()
        (at,) = np.flatnonzero(np.isnan(x) | np.isnan(y))
        assert x[at - 1] == pytest.approx(119 / 50) and x[at + 1] == pytest.approx(170 / 50)
    for line in figure.axes[2].lines:
        assert not np.isfinite(line.get_ydata()[120])
    assert "no sample of 50 ticks between 2.380 and 3.400 s" in words(figure)[1]


def test_a_long_run_with_a_hole_is_broken_too(tmp_path):
    samples = np.resize(samples_of(), 45_000)
    samples["tick"], samples["time_s"] = np.arange(45_000), np.arange(45_000) / 50
    x, y = draw_drive_figure(journal(tmp_path, np.delete(samples, np.r_[30_000:31_000]))).axes[0].lines[1].get_data()
    (at,) = np.flatnonzero(np.isnan(y))
    assert x[at - 1] < 600 and x[at + 1] >= 620


def test_what_was_asked_for_lies_under_what_was_measured(tmp_path):
    lines = {line.get_label(): line for line in draw_drive_figure(journal(tmp_path)).axes[0].lines}
    assert lines["asked for"].get_zorder() < lines["measured"].get_zorder()


def test_a_pause_has_a_ground_and_near_marks_share_their_words(tmp_path, monkeypatch):
    monkeypatch.setitem(EVENTS, 105, [{"kind": "mark", "tick": 105, "time_s": 2.1, "text": "top"}])
    monkeypatch.setitem(EVENTS, 106, [{"kind": "pause", "tick": 106, "time_s": 2.12}])
    monkeypatch.setitem(EVENTS, 150, [{"kind": "resume", "tick": 150, "time_s": 3.0}])
    pressure, angle, _ = draw_drive_figure(journal(tmp_path)).axes
    assert [text.get_text() for text in pressure.texts] == ["camera, up $x_{$", "top, pause", "second"]
    for ax in (pressure, angle):
        (ground,) = ax.patches
        assert ground.get_x() == pytest.approx(2.12) and ground.get_width() == pytest.approx(0.88)


def test_words_too_long_for_a_line_go_on_in_the_next(tmp_path):
    why = " ".join(f"reason{index}" for index in range(40))
    told = words(draw_drive_figure(journal(tmp_path, stop={**STOPPED, "words": why})))
    assert "reason39" in " ".join(told[1:4]) and "…" not in " ".join(told[1:4])


@pytest.mark.parametrize("count", [1, 2, 45_000])
def test_short_and_long_runs_are_drawn(tmp_path, count):
    samples = np.resize(samples_of(), count)
    samples["tick"], samples["time_s"] = np.arange(count), np.arange(count) / 50
    figure = draw_drive_figure(journal(tmp_path, samples, stop=None))
    assert len(figure.axes[0].lines[0].get_xdata()) <= 20_000
    save_png(figure, tmp_path / "a.png")
    assert (tmp_path / "a.png").stat().st_size > 10_000
