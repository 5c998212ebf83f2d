"""A page in headless Chromium: its picture, and what a reader would call a fault in its layout."""

from __future__ import annotations

import html
import json
import shutil
import subprocess
import tempfile
from dataclasses import dataclass
from pathlib import Path

import pytest

FLAGS = ("--headless", "--no-sandbox", "--disable-gpu", "--disable-quic", "--no-first-run", "--disable-background-networking",
         "--disable-component-update", "--disable-sync", "--hide-scrollbars", "--virtual-time-budget=8000")  # fmt: skip

MEASURE = """
const frames = [...document.querySelectorAll("iframe")];
const measured = frame => {
const page = frame.contentDocument, view = page.defaultView;
const boxes = [], small = [], walker = page.createTreeWalker(page.body, NodeFilter.SHOW_TEXT);
while (walker.nextNode()) {
  const node = walker.currentNode, style = view.getComputedStyle(node.parentElement);
  if (!node.data.trim() || style.display === "none" || node.parentElement.closest("svg, style")) continue;
  if (parseFloat(style.fontSize) < 11) small.push(node.data.trim().slice(0, 60));
  const range = page.createRange();
  range.selectNodeContents(node);
  for (const r of range.getClientRects())
    if (r.width > 0) boxes.push([r.left, r.top, r.right, r.bottom, node.data.trim().slice(0, 60), !!node.parentElement.closest(".scroll")]);
}
for (const svg of page.querySelectorAll("svg")) {
  const r = svg.getBoundingClientRect();
  boxes.push([r.left, r.top, r.right, r.bottom, "figure: " + svg.getAttribute("aria-label"), false]);
}
const overlaps = [];
boxes.sort((a, b) => a[1] - b[1]);
for (let i = 0; i < boxes.length; i++)
  for (let j = i + 1; j < boxes.length && boxes[j][1] < boxes[i][3] - 2; j++)
    if (Math.min(boxes[i][2], boxes[j][2]) - Math.max(boxes[i][0], boxes[j][0]) > 1 && Math.min(boxes[i][3], boxes[j][3]) - boxes[j][1] > 2.5)
      overlaps.push([boxes[i][4], boxes[j][4]]);
const width = view.innerWidth;
const outside = boxes.filter(b => !b[5] && (b[0] < -1 || b[2] > width + 1)).map(b => b[4]);
const wide = page.documentElement.scrollWidth, height = page.documentElement.scrollHeight;
return {width, wide, height, texts: boxes.length, small, overlaps, outside};
};
let waited = frames.length;
for (const frame of frames)
  frame.onload = () => {
    if (--waited) return;
    const found = JSON.stringify(frames.map(measured));
    document.body.innerHTML = "";
    document.body.append(found);
  };
"""


@dataclass(frozen=True)
class Layout:
    """width: of the window in px; wide: of what is in it. texts: boxes of text seen. small: texts under 11 px. overlaps: pairs of texts
    or figures. outside: texts or figures that reach out of the window, tables that can be scrolled left aside."""

    width: int
    wide: int
    height: int
    texts: int
    small: list[str]
    overlaps: list[list[str]]
    outside: list[str]

    @property
    def faults(self) -> list[object]:
        wider = [f"{self.wide} px wide in a window of {self.width}"] if self.wide > self.width else []
        return [*wider, *self.small, *self.overlaps, *self.outside]


def chromium() -> str:
    """Its path; the test is skipped where there is none."""
    found = shutil.which("chromium") or shutil.which("chromium-browser") or shutil.which("google-chrome")
    if found is None:
        pytest.skip("Chromium is not installed: the page was not opened (Debian: apt-get install chromium)")
    return found


def layouts(page: str, *widths: int) -> list[Layout]:
    """The faults of a page in windows of these widths in px. Measured in frames, on a copy that lets a script look."""
    assert "Content-Security-Policy" in page
    free = page.replace("Content-Security-Policy", "X-Not-A-Policy")
    escaped = html.escape(free)
    frames = [f'<iframe style="border:0;width:{w}px;height:900px" srcdoc="{escaped}"></iframe>' for w in widths]
    outer = f"<!doctype html>{''.join(frames)}<script>{MEASURE}</script>"
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "frame.html"
        path.write_text(outer, encoding="utf-8")
        dom = run(path, "--dump-dom", "--window-size=1400,1000").stdout.decode()
    told = dom[dom.index("<body>") + 6 : dom.index("</body>")]
    return [Layout(**one) for one in json.loads(html.unescape(told))]


def run(page: Path, *options: str) -> subprocess.CompletedProcess[bytes]:
    """Chromium on a local file, with a profile of its own."""
    with tempfile.TemporaryDirectory(ignore_cleanup_errors=True) as profile:
        command = [chromium(), *FLAGS, f"--user-data-dir={profile}", *options, page.resolve().as_uri()]
        return subprocess.run(command, capture_output=True, timeout=600, check=True)
