"""The page of a report in Chromium, with the network off: `python -m tests browser`.

Needs the extra `browser` and a Chromium, so it is no part of what pytest finds by itself. Set
SATCHECK_SCREENSHOTS to a folder to look at each scene in light and dark.
"""

from __future__ import annotations

import json
import os
import re
import shutil
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Literal

import pytest
from playwright.sync_api import Browser, Page, Request, ViewportSize, sync_playwright

from tests.browser.browsers import ARGUMENTS, program
from tests.cli.process import PUSHED, SAMPLES, satcheck

Theme = Literal["light", "dark"]
Opened = Callable[..., Page]
CONCAVE = ("l_bracket.obj", "peg_in_arm.ply")
MANY = 1000
ON_PATH = ("arm.urdf", "arm.srdf", "--path", "arm_poses.json")
SCENES: dict[str, tuple[str, ...]] = {
    "kettle": ("kettle.obj", "snowflake.obj"),
    "concave": ("--components", *CONCAVE),
    "rack": ("--depth", "rack.3mf"),
    "many": ("--allow-outside", "--units", "m", "{}/many.json"),
    "path": ON_PATH,
    "poses": ("arm.urdf", "arm.srdf", "--sample", "60"),
}
# Painted at once, as the buffer is gone after the frame.
SHARE = """(colour) => {
  paint();
  const gl = picture.renderer.gl, [width, height] = [gl.drawingBufferWidth, gl.drawingBufferHeight];
  const pixels = new Uint8Array(4 * width * height);
  gl.readPixels(0, 0, width, height, gl.RGBA, gl.UNSIGNED_BYTE, pixels);
  let count = 0;
  for (let k = 0; k < pixels.length; k += 4) {
    const [r, g, b] = pixels.subarray(k, k + 3);
    count += {
      red: r > 120 && r > 2 * g && r > 2 * b,
      blue: b > 90 && b > 1.3 * r,
      yellow: r > 120 && r > 3 * b && g > 0.6 * r,
    }[colour];
  }
  return count / (width * height);
}"""

# Of the ranges of a mesh that are drawn at once.
OPACITIES = """() => {
  const { renderer } = picture, { translucent } = renderer, seen = [];
  renderer.translucent = (shape, colour, how) => {
    if (how?.range) seen.push(colour[3]);
    translucent.call(renderer, shape, colour, how);
  };
  paint();
  renderer.translucent = translucent;
  return seen;
}"""


@pytest.fixture(scope="module")
def browser() -> Iterator[Browser]:
    with sync_playwright() as playwright:
        chromium = playwright.chromium.launch(executable_path=program(), args=ARGUMENTS)
        yield chromium
        chromium.close()


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("pages")
    side = round(MANY ** (1 / 3))
    names = ("kettle.obj", "snowflake.obj", "l_bracket.obj", "rod.stl")
    bodies = [
        {
            "id": f"part-{k}",
            "mesh": str(SAMPLES / names[k % len(names)]),
            "position": [4.0 * (k % side), 4.0 * (k // side % side), 4.0 * (k // side**2)],
            "euler": [37 * k % 360, 53 * k % 360, 71 * k % 360],
        }
        for k in range(MANY)
    ]
    text = json.dumps({"schema": "satcheck.scene/1", "bodies": bodies})
    (path / "many.json").write_text(text)
    return path


@pytest.fixture
def opened(browser: Browser, folder: Path) -> Iterator[Opened]:
    """Opens the page of a check. Nothing may be asked of the network, or said on the console."""
    complaints: list[str] = []

    def watched(request: Request) -> None:
        if not request.url.startswith("file:"):
            complaints.append(request.url)

    def opening(*arguments: str, theme: Theme = "light") -> Page:
        size: ViewportSize = {"width": 1200, "height": 800}
        context = browser.new_context(offline=True, color_scheme=theme, viewport=size)
        page = context.new_page()
        page.on("pageerror", lambda error: complaints.append(str(error)))
        page.on("console", lambda message: complaints.append(message.text))
        page.on("request", watched)
        page.goto(page_of(folder, *arguments).as_uri())
        page.wait_for_selector("body[data-ready]")
        return page

    yield opening
    for context in browser.contexts:
        context.close()
    assert complaints == []


def page_of(folder: Path, *arguments: str) -> Path:
    """Made once."""
    output = folder / f"{re.sub('[^a-z_]+', '-', '-'.join(arguments))[-60:]}.html"
    if not output.exists():
        given = (word.replace("{}", str(folder)) for word in arguments)
        ran = satcheck(*given, "-o", str(output))
        assert ran.code in (0, 1, 3), ran.err
    return output


def share(page: Page, colour: str) -> float:
    value: float = page.evaluate(SHARE, colour)
    return value


def labels(page: Page) -> dict[str, str]:
    """What each is about, and its text."""
    page.evaluate("paint()")
    found: dict[str, str] = page.evaluate(
        """Object.fromEntries([...document.querySelectorAll("#labels span")].map(
          (label) => [label.dataset.kind, label.textContent]))"""
    )
    return found


def press(page: Page, *keys: str) -> None:
    for key in keys:
        page.keyboard.press(key)


@pytest.mark.parametrize("theme", ["light", "dark"])
@pytest.mark.parametrize("scene", SCENES)
def test_each_scene_is_drawn_without_an_error(opened: Opened, scene: str, theme: Theme) -> None:
    page = opened(*SCENES[scene], theme=theme)
    assert page.evaluate("document.documentElement.dataset.theme") == theme
    assert page.evaluate("picture.renderer.gl.getError()") == 0
    assert page.locator("#problem").is_hidden()
    assert share(page, "red") > 1e-4
    if place := os.environ.get("SATCHECK_SCREENSHOTS"):
        page.screenshot(path=Path(place) / f"{scene}-{theme}.png")


def test_a_click_shows_a_finding(opened: Opened) -> None:
    page = opened(*SCENES["rack"])
    first = page.locator("#detail").inner_text()
    page.locator("#findings li").nth(1).click()
    assert page.locator("#detail").inner_text() != first
    assert page.locator("#findings li").nth(1).get_attribute("aria-selected") == "true"
    assert page.locator("#findings").get_attribute("aria-activedescendant") == "finding-1"
    press(page, "ArrowUp")
    assert page.locator("#detail").inner_text() == first
    press(page, "End")
    assert page.evaluate("state.selected") == page.locator("#findings li").count() - 1
    press(page, "Escape")
    assert page.evaluate("state.selected") == -1


def test_the_slider_ends_the_overlap(opened: Opened) -> None:
    page = opened(*CONCAVE)
    page.locator("#ball").uncheck()
    before = share(page, "red")
    page.locator("#slider").fill("0.5")
    half = share(page, "red")
    page.locator("#slider").fill("1")
    after = share(page, "red")  # the curves stay where they were
    assert before > half > after
    assert after < 0.2 * before
    press(page, " ")
    assert share(page, "red") == pytest.approx(before)


def test_each_rung_sees_something_else(opened: Opened) -> None:
    page = opened("--accuracy", "parts", *CONCAVE)
    seen = {}
    for rung in ("triangles", "parts", "hulls", "boxes"):
        page.locator("#rung").select_option(rung)
        seen[rung] = share(page, "red"), share(page, "blue")
    assert seen["hulls"][0] > 1.2 * seen["triangles"][0]
    assert len(set(seen.values())) >= 3
    press(page, "h")
    assert page.locator("#rung").input_value() == "hulls"
    press(page, "h")
    assert page.locator("#rung").input_value() == "triangles"


def test_parts_that_overlap_stand_out(opened: Opened) -> None:
    """The opacity of each part. Of a report that lists no pairs of parts all are alike, and the
    page shows triangles first."""
    seen = []
    for asked, first in (("--accuracy", "parts"), "triangles"), (("--parts",), "parts"):
        page = opened(*asked, "--no-depth", *CONCAVE)
        assert page.locator("#rung").input_value() == first
        page.locator("#rung").select_option("parts")
        seen.append(page.evaluate(OPACITIES))
    alike, told = seen
    assert len(alike) == len(told)
    assert len(set(alike)) == 1
    overlapping = page.evaluate("report.findings[0].parts")
    assert told.count(alike[0]) == sum(map(len, overlapping))
    assert 0 < told.count(min(told)) < len(told)
    assert min(told) < alike[0]


def test_without_parts_there_is_nothing_to_choose(opened: Opened) -> None:
    page = opened(*CONCAVE)
    assert page.locator("#rung option[value=parts]").is_disabled()
    press(page, "p")
    assert page.locator("#rung").input_value() == "triangles"


def test_the_ball_has_its_number(opened: Opened) -> None:
    page = opened(*PUSHED)
    page.wait_for_selector("#labels span")
    assert labels(page) == {
        "a": "box", "b": "box_pushed", "ball": "thickness 1", "arrow": "move box by 1"
    }  # fmt: skip
    assert share(page, "yellow") > 0.001
    press(page, "i")
    assert share(page, "yellow") == 0
    assert "ball" not in labels(page)
    press(page, "l")
    page.wait_for_function("!document.getElementById('labels').children.length")


def test_the_ball_is_gone_where_the_overlap_has_ended(opened: Opened) -> None:
    page = opened(*PUSHED)
    page.wait_for_selector("#labels span")
    page.locator("#slider").fill("0.5")
    assert share(page, "yellow") > 0.001
    page.locator("#slider").fill("1")
    assert share(page, "yellow") == 0
    assert "ball" not in labels(page)
    page.locator("#slider").fill("0")
    assert share(page, "yellow") > 0.001


def test_the_list_has_the_figures_in_the_order_of_the_table(opened: Opened) -> None:
    page = opened(*SCENES["rack"])
    items = page.locator("#findings li")
    assert re.search(r"penetrating, thickness \d.* to pull apart", items.first.inner_text())
    names = page.evaluate("report.findings.map((each) => each.names.join(' and '))")
    shown = [items.nth(k).locator("div").inner_text() for k in range(items.count())]
    assert shown == names
    assert page.locator("#title").inner_text() == "1 of 6 pairs overlaps" == page.title()


def test_the_summary_and_the_warnings_open(opened: Opened) -> None:
    page = opened("open_box.off", "kettle.obj", "snowflake.obj")
    for heading, text in (("#headline", "#summary"), ("#warnings", "#issues")):
        assert page.locator(text).is_hidden()
        page.locator(f"{heading} summary").click()
        assert page.locator(text).is_visible()
    assert page.locator("#issues-count").inner_text() == "1 warning"
    assert "FAIL: " in page.locator("#summary").inner_text()


def test_the_axis_shows_both_shadows(opened: Opened) -> None:
    """Two cubes of 2, of which one reaches 1 into the other."""
    page = opened(*PUSHED)
    press(page, "i", "x")
    page.wait_for_function("document.getElementById('labels').textContent.includes('shadows')")
    assert labels(page)["axis"] == "shadows overlap by 1"
    page.locator("#slider").fill("1")
    page.wait_for_function("document.getElementById('labels').textContent.includes('touch')")
    shadows = page.evaluate("picture.shadows.both.map(([low, high]) => high - low)")
    assert shadows == pytest.approx([2, 2], rel=1e-4)


def test_places_of_an_overlap(opened: Opened) -> None:
    page = opened(*SCENES["concave"])
    before = page.evaluate("camera.far")
    page.locator("#components button").first.click()
    assert page.locator("#components button").first.get_attribute("aria-pressed") == "true"
    assert page.evaluate("camera.far") < before
    press(page, "f")
    assert page.evaluate("camera.far") == before


def test_the_search_leaves_what_it_names(opened: Opened) -> None:
    page = opened(*SCENES["rack"])
    press(page, "/")
    page.keyboard.type("crate")
    visible = page.locator("#findings li:visible")
    assert visible.count() == 1
    assert "crate" in visible.first.inner_text()
    assert "1 of 3 findings" in page.locator("#count").inner_text()
    press(page, "Enter")
    assert page.evaluate("state.selected") == -1


def test_the_mouse_turns_and_zooms(opened: Opened) -> None:
    page = opened(*PUSHED)
    before = page.evaluate("[camera.yaw, camera.far, ...camera.target]")
    page.mouse.move(800, 500)
    page.mouse.wheel(0, -300)
    page.mouse.down()
    page.mouse.move(900, 540, steps=3)
    page.mouse.up()
    after = page.evaluate("[camera.yaw, camera.far, ...camera.target]")
    assert after[0] != before[0]
    assert after[1] < before[1]
    assert after[2:] == before[2:]


def test_another_axis_points_up(opened: Opened) -> None:
    page = opened(*PUSHED)
    assert page.evaluate("camera.world([0, 0, 1])") == [0, 0, 1]
    press(page, "u")
    assert page.locator("#up").input_value() == "y"
    assert page.evaluate("camera.world([0, 0, 1])") == [0, 1, 0]
    assert share(page, "red") > 0.01


def test_every_control_has_a_name(opened: Opened) -> None:
    page = opened(*SCENES["concave"])
    for role in ("button", "checkbox", "slider", "combobox", "searchbox", "listbox", "option"):
        for each in page.get_by_role(role).all():
            snapshot = each.aria_snapshot()
            assert re.match(rf"""- '?{role} ".+\"""", snapshot), snapshot
    assert "l_bracket and peg_in_arm" in str(page.locator("#view").get_attribute("aria-label"))


def test_names_are_never_markup(opened: Opened, folder: Path) -> None:
    for name in PUSHED:
        shutil.copy(SAMPLES / name, folder / f"<img src=x onerror=bad=1><script>bad=1<-{name}")
    names = sorted(str(path) for path in folder.glob("<img*"))
    page = opened("--components", *names)
    press(page, "c", "x")
    assert page.evaluate("typeof bad") == "undefined"
    assert page.locator("img, script script").count() == 0
    assert "<script>" in page.locator("#detail").inner_text()


def test_bodies_of_one_mesh_are_drawn_at_once(opened: Opened) -> None:
    page = opened(*SCENES["many"])
    calls = page.evaluate(
        """() => {
          const gl = picture.renderer.gl, counts = {};
          for (const name of ["drawElements", "drawArrays", "drawElementsInstanced"]) {
            const draw = gl[name].bind(gl);
            counts[name] = 0;
            gl[name] = (...given) => { counts[name]++; return draw(...given); };
          }
          select(-1); paint();
          return counts;
        }"""
    )
    dots = 1  # of all errors
    assert calls == {"drawElements": 0, "drawArrays": dots, "drawElementsInstanced": 4}
    assert page.evaluate("report.bodies.ids.length") == MANY


def test_the_camera_looks_across_the_way_out(opened: Opened) -> None:
    page = opened(*SCENES["rack"])
    along = page.evaluate("Math.abs(dot(camera.axis, unit(finding().mtv)))")
    assert along < 0.3
    press(page, "End", "Home")
    assert page.evaluate("Math.abs(dot(camera.axis, unit(finding().mtv)))") == pytest.approx(along)


def test_the_eye_is_outside_of_a_large_body(opened: Opened) -> None:
    """A seed within the arm of a bracket."""
    page = opened("l_bracket.obj", "seed_in_arm.stl")
    low, high = page.evaluate("picture.box(finding().a)")
    eye = page.evaluate("camera.eye")
    assert any(not a <= c <= b for a, c, b in zip(low, eye, high, strict=True))
    assert share(page, "red") > 0.001


def test_a_gap_is_drawn(opened: Opened) -> None:
    page = opened("cell.toml")
    assert labels(page)["gap"] == "gap 40 mm"
    points = page.evaluate("finding().gap")
    assert sum((a - b) ** 2 for a, b in zip(*points, strict=True)) ** 0.5 == pytest.approx(40)


def test_a_path_begins_at_the_first_impact(opened: Opened) -> None:
    page = opened(*ON_PATH)
    assert page.locator("#when").inner_text() == "t = 0.491"
    assert labels(page)["hit"] == "hit at t = 0.491, between poses 1 and 2"
    assert share(page, "red") > 1e-5
    place = "placedAt(picture.rows(finding().b), [0, 0, 0])"
    at_hit = page.evaluate(place)
    page.locator("#moment").fill("0")
    assert page.locator("#when").inner_text() == "t = 0"
    assert page.evaluate(place) != at_hit
    assert "hit" not in labels(page)
    page.locator("#findings li").first.click()
    assert page.evaluate(place) == at_hit
    press(page, ".")
    assert page.locator("#when").inner_text() != "t = 0.491"


def test_all_bodies_are_not_red(opened: Opened) -> None:
    page = opened(*SCENES["rack"])
    press(page, "a")
    assert 0 < share(page, "red") < 0.002  # a dot


@pytest.mark.parametrize(("height", "least", "most"), [(12.48, 0.002, 1.0), (12.5, 0.0, 0.0)])
def test_an_overlap_thinner_than_a_pixel_is_red(
    opened: Opened, tmp_path: Path, height: float, least: float, most: float
) -> None:
    """A block stands 0.02 mm deep in a plate that is seen at a low angle. One that stands on it has
    a face in the plane of the plate, which is not red from anywhere."""
    shape = 'shape = {{type = "box", size = {}}}\nposition = {}\n'
    bodies = {
        "plate": shape.format([50, 30, 5], [0, 0, 0]),
        "block": shape.format([20, 20, 20], [5, 2, height]),
    }
    text = "".join(f'[[bodies]]\nid = "{id_}"\n{lines}' for id_, lines in bodies.items())
    path = tmp_path / ("thin.toml" if least else "flush.toml")
    path.write_text(f'schema = "satcheck.scene/1"\nunits = "mm"\n{text}')
    page = opened("--fail-on", "note", str(path))
    page.evaluate("for (const id of ['ball', 'names']) element(id).checked = false")
    page.evaluate("picture.strips = []; report.findings[0].overlaps = true")
    assert least <= share(page, "red") <= most
    for turn in range(20):
        page.evaluate(f"camera.turn(0.37, {0.05 if turn % 2 else -0.04})")
        assert share(page, "red") <= most, turn
