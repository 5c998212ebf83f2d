"""The figure of a series: what is drawn is what was measured, in words that survive any file name."""

import os
import subprocess
import sys
import threading
import warnings
from dataclasses import replace
from pathlib import Path

import cv2
import numpy as np
import pytest

from benchlab.report.figures import (
    draw_curvature_figure,
    plot_angle_over_pressure,
    plot_angle_over_time,
    save_png,
)
from benchlab.report.panels import MAX_DRAWN
from benchlab.report.wording import drawable, flag_groups
from benchlab.vision.series import CurvatureSeries


def inflation(n=600, stills=False, pressure=True) -> CurvatureSeries:
    """θ = 120° · p / 0.35 MPa up and down, 0.5° of sd; frames 100–149 not seen, 300–399 doubtful."""
    time_s = np.arange(n) / 60
    p = 0.35 * np.minimum(np.arange(n), np.arange(n)[::-1]) / max(1, n / 2)
    angle, sd, rms = np.radians(120 * p / 0.35), np.full(n, np.radians(0.5)), 0.1 + 2 * p
    used = np.ones((n, 5), bool)
    flag = [""] * n
    for i in range(n):
        if 100 <= i < 150:
            angle[i] = sd[i] = rms[i] = np.nan
            used[i] = False
            flag[i] = "no markers"
        elif 300 <= i < 400:
            flag[i] = "not constant curvature;large uncertainty" if i < 310 else "not constant curvature"
    return CurvatureSeries(
        time_s=np.full(n, np.nan) if stills else time_s,
        markers_px=np.zeros((n, 5, 2)),
        used=used,
        angle_rad=angle,
        angle_sd_rad=sd,
        curvature_per_mm=angle / 180,
        curvature_sd_per_mm=sd / 180,
        radius_mm=np.full(n, np.nan),
        centre_px=np.zeros((n, 2)),
        radius_px=np.ones(n),
        curvature_per_px=angle / 720,
        fit_rms_px=rms,
        centroid_sd_px=np.ones(n),
        flag=tuple(flag),
        names=tuple(f"{i}.jpg" for i in range(n)) if stills else (),
        pressure_MPa=p if pressure else None,
    )


def bare_axes():
    from matplotlib.figure import Figure

    return Figure().subplots()


def words(figure):
    figure.draw_without_rendering()
    return [t.get_text() for t in figure.findobj(match=lambda o: hasattr(o, "get_text")) if t.get_text()]


def picture(figure, path):
    save_png(figure, path)
    pixels = cv2.imread(str(path))
    assert pixels is not None
    return pixels


def test_theta_is_drawn_in_degrees_over_time_with_gaps():
    series = inflation()
    ax = bare_axes()
    plot_angle_over_time(ax, series)
    x, y = ax.lines[0].get_data()
    np.testing.assert_array_equal(x, series.time_s)
    np.testing.assert_allclose(y, np.degrees(series.angle_rad))
    assert np.isnan(y[100:150]).all()
    assert ax.get_xlabel() == "time (s)"
    assert ax.get_ylabel() == "bending angle θ (°)"


def test_the_band_is_two_standard_deviations_wide():
    series = inflation()
    ax = bare_axes()
    plot_angle_over_time(ax, series)
    band = np.concatenate([path.vertices for path in ax.collections[0].get_paths()])
    at = band[np.isclose(band[:, 0], series.time_s[50])]
    theta = np.degrees(series.angle_rad[50])
    assert sorted({round(y, 6) for y in at[:, 1]}) == [pytest.approx(theta - 1), pytest.approx(theta + 1)]
    assert not ((band[:, 0] > series.time_s[100]) & (band[:, 0] < series.time_s[149])).any()


def test_theta_over_pressure_follows_the_frames():
    series = inflation()
    ax = bare_axes()
    plot_angle_over_pressure(ax, series)
    x, y = ax.lines[0].get_data()
    known = np.isfinite(y)
    np.testing.assert_allclose(y[known], 120 * x[known] / 0.35)
    segments = ax.collections[0].get_segments()
    assert len(segments) == known.sum()
    np.testing.assert_allclose([s[1, 1] - s[0, 1] for s in segments], 2.0)
    assert ax.get_xlabel() == "pressure (MPa)"


@pytest.mark.parametrize(("pressure", "panels"), [(True, 5), (False, 3)])
def test_panels_of_the_figure(pressure, panels):
    figure = draw_curvature_figure(inflation(pressure=pressure), "a.mp4", "drawn data")
    assert len(figure.axes) == panels
    said = words(figure)
    assert "residual (px)" in said
    assert ("pressure (MPa)" in said) == pressure
    assert {"a.mp4", "drawn data", "± 2 standard deviations", "bending angle θ"} <= set(said)


def test_no_pressure_panel_where_the_record_is_elsewhere():
    series = replace(inflation(), pressure_MPa=np.full(600, np.nan))
    assert len(draw_curvature_figure(series, "a.mp4").axes) == 3


def test_the_legend_says_why_and_how_many():
    said = words(draw_curvature_figure(inflation(), "a.mp4"))
    assert "not constant curvature (100 frames)" in said
    assert "no markers (50 frames, not measured)" in said
    assert "large uncertainty (10 frames)" in said


def test_flags_are_grouped_by_word_the_commonest_first():
    groups = flag_groups(inflation(), 5)
    assert [(label.split(" (")[0], len(frames)) for label, frames in groups] == [
        ("not constant curvature", 100),
        ("no markers", 50),
        ("large uncertainty", 10),
    ]
    assert groups[1][1].tolist() == list(range(100, 150))
    many = replace(inflation(20), flag=tuple(f"reason {i // 2}" for i in range(20)))
    labels = [label for label, _ in flag_groups(many, 4)]
    assert labels[-1].startswith("7 other reasons (14 frames")
    assert len(labels) == 4


def test_stills_are_over_the_picture_number():
    figure = draw_curvature_figure(inflation(6, stills=True, pressure=False), "pins")
    assert "picture number (from 0)" in words(figure)
    assert figure.axes[0].lines[0].get_xdata().tolist() == [0, 1, 2, 3, 4, 5]
    assert figure.axes[0].lines[0].get_marker() == "o"


@pytest.mark.parametrize("n", [1, 2])
def test_few_frames_are_points(n, tmp_path):
    figure = draw_curvature_figure(inflation(n), "a.mp4")
    assert figure.axes[0].lines[0].get_marker() == "o"
    assert (picture(figure, tmp_path / "a.png") < 128).any()


def test_a_frame_alone_between_gaps_is_seen():
    series = inflation()
    angle = series.angle_rad.copy()
    angle[125] = 1.0
    ax = bare_axes()
    plot_angle_over_time(ax, replace(series, angle_rad=angle, angle_sd_rad=np.full(600, 0.01)))
    assert ax.containers[0].lines[0].get_data()[1] == pytest.approx([np.degrees(1.0)])


def test_nothing_measured_is_said():
    nothing = np.full(600, np.nan)
    series = replace(inflation(), angle_rad=nothing, angle_sd_rad=nothing, fit_rms_px=nothing)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        said = words(draw_curvature_figure(series, "a.mp4"))
    assert said.count("no frame could be measured") == 2


@pytest.mark.parametrize(
    "name",
    [
        "$x_{$.mp4",
        "a\x00b\x1b[31m\n.mp4",
        "<script>alert(1)</script>",
        "x" * 5000,
        "中文 🙂.mp4",
        "\\alpha^$$",
        "",
        "W" * 300,
    ],
)
def test_any_file_name_is_plain_text_within_the_page(name, tmp_path):
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        figure = draw_curvature_figure(inflation(30, pressure=False), name, name)
        save_png(figure, tmp_path / "a.png")
    title, note = figure.texts
    for text in (title, note):
        assert text.get_text().isprintable()
        assert not text.get_parse_math()
        if "W" not in name:
            assert text.get_window_extent().x1 <= figure.bbox.x1


def test_words_are_at_least_nine_points():
    figure = draw_curvature_figure(inflation(), "a.mp4", "note")
    figure.draw_without_rendering()
    sizes = [t.get_fontsize() for t in figure.findobj(match=lambda o: hasattr(o, "get_fontsize")) if t.get_text()]
    assert min(sizes) >= 9


def test_panels_do_not_overlap_and_nothing_leaves_the_page():
    reasons = tuple(f"a rather long reason number {i % 6} of many" for i in range(600))
    for series in (inflation(), inflation(pressure=False), replace(inflation(pressure=False), flag=reasons)):
        figure = draw_curvature_figure(series, "a.mp4", "note")
        figure.draw_without_rendering()
        page = figure.bbox
        legend = figure.legends[0].get_window_extent()
        for ax in figure.axes:
            box = ax.get_tightbbox()
            assert page.x0 <= box.x0 and box.x1 <= page.x1 + 1, ax
            assert box.y0 >= legend.y1 - 1
        assert page.x0 <= legend.x0 and legend.x1 <= page.x1
        assert page.y0 <= legend.y0
        boxes = [ax.get_window_extent() for ax in figure.axes]
        assert not any(a.overlaps(b) for i, a in enumerate(boxes) for b in boxes[:i])


def test_the_picture_is_a_png_of_150_dpi(tmp_path):
    figure = draw_curvature_figure(inflation(), "a.mp4")
    pixels = picture(figure, tmp_path / "a.png")
    assert pixels.shape[1] == 11.5 * 150
    blue = (np.abs(pixels.astype(int) - [0xB2, 0x72, 0x00]) < 12).all(axis=2)
    assert blue[:, : pixels.shape[1] // 2].sum() > 500
    assert blue[:, pixels.shape[1] // 2 :].sum() > 500


def test_a_long_recording_keeps_its_extremes_and_is_drawn(tmp_path):
    series = inflation(200_000)
    angle = series.angle_rad.copy()
    angle[77_777] = 3.0
    series = replace(series, angle_rad=angle)
    figure = draw_curvature_figure(series, "long.mp4")
    drawn = figure.axes[0].lines[0].get_ydata()
    assert len(drawn) <= 1.1 * MAX_DRAWN
    assert np.nanmax(drawn) == pytest.approx(np.degrees(3.0))
    picture(figure, tmp_path / "long.png")


def test_figures_are_drawn_in_threads(tmp_path):
    def draw(i):
        save_png(draw_curvature_figure(inflation(100 + i), f"{i}.mp4"), tmp_path / f"{i}.png")

    threads = [threading.Thread(target=draw, args=(i,)) for i in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert len(list(tmp_path.glob("*.png"))) == 4


def test_without_a_writable_home_and_without_pyplot(tmp_path):
    """Row 148: nothing on standard error, and the picture is there."""
    code = (
        "import sys\nfrom pathlib import Path\nsys.path.insert(0, sys.argv[2])\nfrom test_figures import inflation\n"
        "from benchlab.report.figures import draw_curvature_figure, save_png\n"
        "save_png(draw_curvature_figure(inflation(), 'a.mp4'), Path(sys.argv[1]))\n"
        "assert 'matplotlib.pyplot' not in sys.modules\n"
    )
    kept = {key: value for key, value in os.environ.items() if not key.startswith(("MPL", "XDG"))}
    done = subprocess.run(
        [sys.executable, "-B", "-c", code, str(tmp_path / "a.png"), str(Path(__file__).parent)],
        capture_output=True,
        text=True,
        check=False,
        env={**kept, "HOME": "/proc/none"},
    )
    assert (done.returncode, done.stderr) == (0, "")
    assert (tmp_path / "a.png").stat().st_size > 10_000


def test_long_words_are_cut_in_the_middle():
    assert drawable("a" * 20 + ".mp4", 11) == "aaaaaa….mp4"
    assert drawable("a.mp4", 11) == "a.mp4"
    assert len(drawable("x" * 5000, 60)) == 60
