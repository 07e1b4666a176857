"""The image of the worst finding: what is where, in the pixels of the file."""

from __future__ import annotations

import io
from pathlib import Path

import matplotlib.image
import numpy as np
import pytest

from satcheck.audit import Settings, check
from satcheck.cli.formats.picture.png import BAND, KINDS, OVERLAP, SIZE, WHITE, image_file, render
from satcheck.cli.formats.picture.raster import Kind, Triangles, drawn
from satcheck.core.errors import SatcheckError
from satcheck.scene import Scene, load_scene
from satcheck.scene.meshes import scene_of_meshes
from tests.cli.process import APART, PUSHED, SAMPLES, satcheck

DEPTH = Settings(depth=True, contacts=True)
FLUSH = ("box.obj", "box_flush.stl")


def pixels(content: bytes) -> np.ndarray:
    """As matplotlib reads them: (height, width, 3), 0 to 1."""
    image = matplotlib.image.imread(io.BytesIO(content), format="png")
    return np.asarray(image, dtype=float)


def image_of(*names: str, size: tuple[int, int] = SIZE) -> np.ndarray:
    scene = load_scene([str(SAMPLES / name) for name in names])
    return pixels(render(check(scene, DEPTH), scene, size))


def near(image: np.ndarray, colour: tuple[float, ...], off: float = 0.12) -> np.ndarray:
    close: np.ndarray = np.abs(image - np.array(colour)).max(axis=2) < off
    return close


def quad(low: float, high: float, depth: float, *, away: bool) -> np.ndarray:
    """Two triangles at one depth. away: they face away from the eye."""
    a, b, c, d = ([x, y, depth] for x, y in ((low, low), (high, low), (high, high), (low, high)))
    turned = [[a, b, c], [a, c, d]] if away else [[a, c, b], [a, d, c]]
    return np.array(turned, dtype=float)


def slabs(*ends: tuple[float, float]) -> Triangles:
    """Of each kind a slab from one depth to another."""
    faces = [quad(4, 28, z, away=k == 1) for end in ends for k, z in enumerate(end)]
    kinds = np.repeat(np.arange(len(ends)), 4)
    return Triangles(np.concatenate(faces), kinds)


SOLID = [Kind((0.0, 0.0, 1.0), 1.0), Kind((0.0, 1.0, 0.0), 1.0)]
GLASS = [Kind((0.0, 0.0, 1.0), 0.5), Kind((0.0, 1.0, 0.0), 0.5)]
RED = Kind((1.0, 0.0, 0.0), 1.0)


def middle(triangles: Triangles, kinds: list[Kind]) -> list[float]:
    image = drawn(triangles, kinds, RED, (32, 32), WHITE)
    assert (image[:3] == 255).all()
    colour = (image[16, 16] / 255.0).tolist()
    return [float(each) for each in colour]


def test_the_nearer_body_hides_the_other() -> None:
    assert middle(slabs((5, 6), (2, 3)), SOLID) == pytest.approx([0, 1, 0], abs=0.01)
    assert middle(slabs((2, 3), (5, 6)), SOLID) == pytest.approx([0, 0, 1], abs=0.01)


def test_translucent_faces_lie_over_each_other() -> None:
    """Two faces of each: 1/2 of blue, 1/4 of it, then 1/8 and 1/16 of green over 1/16 of white."""
    expected = [1 / 16, 1 / 16 + 3 / 16, 1 / 16 + 3 / 4]
    assert middle(slabs((2, 3), (5, 6)), GLASS) == pytest.approx(expected, abs=0.01)


@pytest.mark.parametrize(
    ("a", "b", "overlaps"),
    [
        ((2, 5), (4, 8), True),
        ((4, 8), (2, 5), True),
        ((2, 9), (4, 5), True),
        ((2, 4), (4, 8), False),
        ((4, 8), (2, 4), False),
        ((2, 3), (4, 8), False),
    ],
)
def test_red_is_where_a_ray_is_in_both(
    a: tuple[float, float], b: tuple[float, float], overlaps: bool
) -> None:
    red, green, blue = middle(slabs(a, b), GLASS)
    assert (red > 0.8 and green < 0.2 and blue < 0.2) is overlaps


def test_an_open_body_makes_no_red() -> None:
    """A ray that enters a body and never leaves it tells nothing."""
    solid, sheet = slabs((2, 9)), quad(4, 28, 5, away=False)
    both = Triangles(np.concatenate([solid.corners, sheet]), np.array([0, 0, 0, 0, 1, 1]))
    red, *_ = middle(both, GLASS)
    assert red < 0.3


def test_neighbouring_triangles_leave_no_gap_and_share_no_ray() -> None:
    """Any ray through a fan meets one triangle of it: translucent, it has one colour."""
    rng = np.random.default_rng(0)
    angles = np.sort(rng.uniform(0, 2 * np.pi, 40))
    rim = np.stack([32 + 40 * np.cos(angles), 32 + 40 * np.sin(angles), np.zeros(40)], axis=1)
    centre = np.array([31.7, 32.4, 0.0])
    fan = np.array([[centre, rim[k], rim[k - 1]] for k in range(40)])
    image = drawn(Triangles(fan, np.zeros(40, dtype=np.int64)), GLASS, RED, (64, 64), WHITE)
    inner = image[22:42, 22:42]
    assert np.abs(inner.astype(int) - [128, 128, 255]).max() <= 1


def test_both_bodies_and_their_overlap_are_seen() -> None:
    image = image_of(*PUSHED)
    assert image.shape == (SIZE[1], SIZE[0], 3)
    red = near(image, OVERLAP.colour, 0.2)
    assert 0.01 < red.mean() < 0.5
    blue, orange = image[..., 2] > image[..., 0] + 0.2, image[..., 0] > image[..., 2] + 0.2
    assert blue.mean() > 0.05
    assert (orange & ~red).mean() > 0.05
    black = near(image, (0.0, 0.0, 0.0))
    assert black.any()  # the arrow


def test_beside_a_pair_of_a_large_scene_all_of_it_is_seen() -> None:
    pair = load_scene([str(SAMPLES / name) for name in PUSHED]).bodies
    meshes = {body.id: body.world_mesh() for body in pair}
    far = np.eye(4)
    far[0, 3] = 30.0

    def strip_of(scene: Scene) -> np.ndarray:
        """Without the caption."""
        image = pixels(render(check(scene, DEPTH), scene))
        return image[: int(0.88 * SIZE[1]), int(0.76 * SIZE[0]) :]

    alone = strip_of(scene_of_meshes(meshes))
    beside = strip_of(scene_of_meshes({**meshes, "far": pair[0].world_mesh()}, {"far": far}))
    assert near(alone, BAND, 0.005).mean() < 0.05  # labels
    assert near(beside, BAND, 0.005).mean() > 0.7
    ring, grey = near(beside, KINDS[6].colour), np.ptp(beside, axis=2) < 0.04
    assert 0 < ring.mean() < 0.02
    assert (grey & (beside.mean(axis=2) < 0.9)).any()  # the other body


def test_bodies_in_contact_share_nothing_red() -> None:
    image = image_of(*FLUSH)
    red = near(image, KINDS[6].colour)
    assert 0 < red.mean() < 0.01  # the outline of the patch alone


def test_without_a_finding_all_bodies_are_seen() -> None:
    image = image_of(*APART, size=(400, 300))
    assert not (image[..., 0] > image[..., 2] + 0.2).any()
    assert near(image, WHITE).mean() < 0.9


def test_coordinates_beyond_the_picture_are_refused() -> None:
    tip = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]], dtype=float)
    faces = [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]]
    scene = scene_of_meshes({"a": (1e42 * tip, faces), "b": (2e42 * tip, faces)})
    with pytest.raises(SatcheckError) as caught:
        render(check(scene), scene)
    assert caught.value.code == "not-drawable"


def test_the_file_is_read_by_others() -> None:
    rng = np.random.default_rng(1)
    image = rng.integers(0, 256, (7, 5, 3), dtype=np.uint8)
    assert np.rint(pixels(image_file(image)) * 255).astype(np.uint8).tolist() == image.tolist()


def test_beside_the_report_and_in_its_place(tmp_path: Path) -> None:
    beside, instead = tmp_path / "beside.png", tmp_path / "instead.png"
    ran = satcheck(*PUSHED, "-o", str(beside), "-o", "-")
    assert ran.code == 1
    assert "penetrating" in ran.out
    assert ran.err == f"Image of box and box_pushed: {beside}\n"
    ran = satcheck(*PUSHED, "-o", str(instead))
    assert ran.code == 1
    assert ran.err.endswith(f". Image of box and box_pushed: {instead}\n")
    assert beside.read_bytes() == instead.read_bytes()
    report, later = tmp_path / "report.json", tmp_path / "later.png"
    satcheck("--contacts", *PUSHED, "-o", str(report))
    ran = satcheck("view", str(report), "-o", str(later))
    assert (ran.code, ran.out) == (0, "")
    assert ran.err == f"Image of box and box_pushed: {later}\n"
    assert later.read_bytes() == beside.read_bytes()


def test_the_closing_line_names_every_file(tmp_path: Path) -> None:
    report, image, model, text = (str(tmp_path / f"x.{e}") for e in ("json", "png", "glb", "txt"))
    files = ("-o", report, "-o", image, "-o", model, "-o", text)
    ran = satcheck(*PUSHED, *files)
    named = f"Report: {report}, {text}. Image of box and box_pushed: {image}. Model: {model}"
    assert ran.err.splitlines()[-1].endswith(named)
    assert satcheck(*PUSHED, *files, "--quiet").err == ""


def test_a_picture_overwrites_no_input(tmp_path: Path) -> None:
    assert satcheck(*PUSHED, "-o", str(SAMPLES / "box.obj")).code == 2
    assert satcheck(*PUSHED, "-o", str(tmp_path / "none" / "x.png")).code == 2


def test_a_picture_overwrites_no_other_output(tmp_path: Path) -> None:
    report = tmp_path / "x.html"
    ran = satcheck(*PUSHED, "-o", str(report), "-o", str(tmp_path / "." / "x.html"))
    assert (ran.code, report.exists()) == (2, False)
    assert "is given twice" in ran.err
    ran = satcheck(*PUSHED, "-o", str(report), "-o", str(report))
    assert (ran.code, report.exists()) == (2, False)
    assert "is given twice" in ran.err


def test_a_picture_that_cannot_be_made_costs_no_report(tmp_path: Path) -> None:
    vertices = "".join(f"v {x} {y} {z}\n" for x, y, z in ((0, 0, 0), (1e30, 0, 0), (0, 1e30, 0)))
    for name in ("a", "b"):
        (tmp_path / f"{name}.obj").write_text(f"{vertices}f 1 2 3\n")
    ran = satcheck("a.obj", "b.obj", "-o", "x.png", "-o", "x.json", cwd=tmp_path)
    assert (ran.code, (tmp_path / "x.json").exists()) == (2, True)
    assert "there is no picture: coordinates are too large for it" in ran.err
