"""Targets read from files: pictures and grids of heights, triangle meshes; and what is refused."""

from __future__ import annotations

import json
from collections.abc import Callable
from io import BytesIO
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from PIL import Image

from foldmill import FoldmillError, ImpossibleGeometry, InvalidParameters
from foldmill.exchange import fold as fold_file
from foldmill.files import fenced
from foldmill_plugins.waterbomb import DESIGN
from foldmill_plugins.waterbomb.build import Build
from foldmill_plugins.waterbomb.disk import Disk
from foldmill_plugins.waterbomb.height_field import averaged
from foldmill_plugins.waterbomb.mesh_surface import MOST_FACES, promised
from foldmill_plugins.waterbomb.patch import patch

Y, X = np.mgrid[1:-1:61j, -1:1:81j]
HILL = np.exp(-2 * (X**2 + Y**2)) + 0.2 * X
"""Its first row is on top, as in a picture."""


def params(kind: str, file: Path, **values: Any) -> Any:
    extra: dict[str, Any] = {}
    for name in ("n_u", "n_v", "start"):
        if name in values:
            extra[name] = values.pop(name)
    surface = {"kind": kind, "file": str(file), **values}
    return DESIGN.validate({"n_u": 12, "n_v": 9, **extra, "surface": surface})


def saved(folder: Path, suffix: str) -> Path:
    file, share = folder / f"hill{suffix}", (HILL - HILL.min()) / np.ptp(HILL)
    if suffix == ".npy":
        np.save(file, HILL)
    elif suffix in {".csv", ".txt"}:
        np.savetxt(file, HILL, delimiter="," if suffix == ".csv" else " ")
    elif suffix == ".tif":
        Image.fromarray(share.astype(np.float32)).save(file)
    elif suffix == ".png":
        Image.fromarray(np.rint(65535 * share).astype(np.uint16)).save(file)
    else:
        Image.fromarray(np.rint(255 * share).astype(np.uint8)).save(file, quality=100)
    return file


@pytest.mark.parametrize("suffix", [".npy", ".csv", ".txt", ".png", ".tif", ".jpg", ".bmp"])
def test_a_hill_is_the_same_hill_from_any_kind_of_file(suffix: str, tmp_path: Path) -> None:
    asked = params("height-field", saved(tmp_path, suffix), relief=0.2)
    fold, target = DESIGN.run(asked), asked.surface.surface()
    assert fold.meta["status"]["verdicts"] == ["ok"]
    assert fold.meta["distance"]["mean"] < 0.008
    (u0, u1), (v0, v1) = target.u, target.v
    assert (u0, u1, v0, v1) == (-1, 1, -0.75, 0.75)
    top = target.points(np.array([0.4, -0.4, 0.0]), np.array([0.3, 0.3, 0.7]))[:, 2]
    x, y = np.array([0.4, -0.4, 0.0]), np.array([0.4, 0.4, 0.7 / 0.75])
    exact = np.exp(-2 * (x**2 + y**2)) + 0.2 * x
    scale = 0.4 / np.ptp(HILL)
    assert top == pytest.approx((exact - HILL.min()) * scale, abs=0.02 * 0.4)


def test_up_in_a_picture_is_up_and_brighter_is_higher(tmp_path: Path) -> None:
    grey = np.tile(np.linspace(255, 0, 30)[:, None], (1, 20)).astype(np.uint8)
    Image.fromarray(grey).save(tmp_path / "slope.png")
    target = params("height-field", tmp_path / "slope.png", relief=0.5).surface.surface()
    low, high = target.points(np.zeros(2), np.array([-1.0, 1.0]))
    assert (low[1], high[1]) == (-1, 1)
    assert low[2] == pytest.approx(0, abs=1e-9)
    assert high[2] == pytest.approx(1)


def test_averaging_keeps_planes_and_ends_and_softens_noise() -> None:
    rows, columns = np.mgrid[0:90, 0:120]
    plane = 2.0 * rows - columns
    few = averaged(plane, 41)
    assert few.shape == (31, 41)
    inner = few[1:-1, 1:-1] - np.add.outer(
        2 * np.linspace(0, 89, 31)[1:-1], -np.linspace(0, 119, 41)[1:-1]
    )
    assert np.abs(inner).max() < 0.5
    noise = np.random.default_rng(3).normal(size=(90, 120))
    assert averaged(noise, 41).std() < 0.5 * noise.std()


def test_slopes_of_a_patch_are_those_of_its_points_within_and_beyond_its_edge() -> None:
    nodes = np.linspace(-1, 1, 12)
    u, v = np.meshgrid(nodes, nodes, indexing="ij")
    jet = patch(nodes, nodes, np.stack([u + 0.1 * v**2, v, np.sin(u) * np.cos(v)], axis=2))
    at, step = np.array([[0.3, -0.2], [1.3, 0.4], [0.1, -1.2], [-1.1, 1.4]]).T, 1e-5
    here = jet(*at)
    for axis, (one, two) in enumerate(((here.u, here.uu), (here.v, here.vv))):
        ahead, behind = (jet(*(at + s * step * np.eye(2)[:, [axis]])) for s in (1, -1))
        assert one == pytest.approx((ahead.p - behind.p) / (2 * step), abs=1e-8)
        slope = (ahead.u, ahead.v)[axis] - (behind.u, behind.v)[axis]
        assert two == pytest.approx(slope / (2 * step), abs=1e-6)


def test_the_file_s_bytes_are_part_of_the_design(tmp_path: Path) -> None:
    file = saved(tmp_path, ".npy")
    asked = params("height-field", file)
    written = fold_file.write(DESIGN.run(asked))
    record = json.loads(written)["foldmill:design"]["params"]
    assert len(record["surface"]["sha256"]) == 64
    assert fold_file.write(DESIGN.run(DESIGN.validate(record))) == written
    np.save(file, HILL + 0.01 * X)
    with pytest.raises(InvalidParameters, match="other bytes than when this design was made"):
        DESIGN.validate(record)
    file.unlink()
    with pytest.raises(InvalidParameters, match="there is no file"):
        DESIGN.validate(record)


def test_a_file_that_changes_behind_its_parameters_is_told(tmp_path: Path) -> None:
    asked = params("height-field", saved(tmp_path, ".csv"))
    (tmp_path / "hill.csv").write_text("1,2\n3,4\n")
    with pytest.raises(ImpossibleGeometry, match="other bytes"):
        DESIGN.run(asked)


def npy(shape: tuple[int, ...], kind: str) -> bytes:
    """Return the head of an array file that promises more than follows."""
    file = BytesIO()
    head = {"descr": kind, "fortran_order": False, "shape": shape}
    np.lib.format.write_array_header_1_0(file, head)
    return file.getvalue() + b"1234"


def saved_array(values: np.ndarray) -> bytes:
    file = BytesIO()
    np.save(file, values)
    return file.getvalue()


@pytest.mark.parametrize(
    ("name", "content", "said"),
    [
        ("a.png", b"no picture", r"no \.png file .*it is no PNG picture"),
        ("a.png", b"%!PS-Adobe-3.0 EPSF-3.0\n%%BoundingBox: 0 0 9 9\n", "it is no PNG picture"),
        ("a.npy", npy((10**6, 10**6), "<f8"), "does not hold the numbers that it says it holds"),
        ("a.npy", npy((2, 2), "|O"), "does not hold the numbers that it says it holds"),
        ("a.csv", b"1," * 1_000_001, "one of its lines has more than 2000000 characters"),
        ("a.csv", (b"1," * 500_000 + b"1\n") * 9, "more than 4 million numbers"),
        ("a.npy", b"\x93NUMPY", r"no \.npy file"),
        ("a.npy", b"cos\nsystem\n(S'true'\ntR.", r"no \.npy file"),
        ("a.csv", b"1,2,3,4\n1,2\n", "rows have 2 to 4 numbers"),
        ("a.csv", b"a,b\nc,d\n", r"no \.csv file"),
        ("a.csv", b"", r"holds 0 heights; a smooth surface needs at least 4 × 4"),
        ("a.csv", b"1,2,3\n" * 9, r"holds 9 × 3 heights"),
        ("a.csv", b"1,2,3,4\n" * 3 + b"1,2,nan,4\n", "row 4, column 3 is no finite number"),
        ("a.txt", b"1 2 3 inf\n" * 4, r"row 1, column 4 is no finite .*\(and 3 more\)"),
        (
            "a.npy",
            saved_array(np.zeros((5, 6, 3))),
            r"3 dimensions \(5 × 6 × 3\); a field .* one layer",
        ),
        ("a.npy", saved_array(np.zeros(25)), r"1 dimensions \(25\); a field of heights has 2"),
        ("a.svg", b"<svg/>", r"read from \.png .*, not \.svg"),
        ("a", b"", "a file without a suffix"),
    ],
)
def test_a_file_without_a_field_of_heights_is_refused(
    name: str, content: bytes, said: str, tmp_path: Path
) -> None:
    (tmp_path / name).write_bytes(content)
    with pytest.raises(ImpossibleGeometry, match=said):
        DESIGN.run(params("height-field", tmp_path / name))


def test_a_picture_with_too_many_pixels_is_refused_before_it_is_unpacked(tmp_path: Path) -> None:
    Image.new("1", (5000, 4001)).save(tmp_path / "a.png")
    assert (tmp_path / "a.png").stat().st_size < 10_000
    with pytest.raises(ImpossibleGeometry, match="more than 20 million pixels"):
        DESIGN.run(params("height-field", tmp_path / "a.png"))


def test_parameters_from_strangers_name_no_file_but_those_they_may(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.delenv("FOLDMILL_FILES", raising=False)
    own = tmp_path / "own"
    own.mkdir()
    asked = params("height-field", saved(tmp_path, ".npy"))
    np.save(own / "hill.npy", HILL)
    with fenced(own):
        assert DESIGN.run(params("height-field", Path("hill.npy"))).folded is not None
        for kind in ("height-field", "mesh"):
            with pytest.raises(InvalidParameters, match="outside the folder"):
                params(kind, tmp_path / "hill.npy")
        with pytest.raises(ImpossibleGeometry, match="outside the folder"):
            asked.surface.content()
    with fenced(None):
        with pytest.raises(InvalidParameters, match="may not name files here"):
            params("mesh", Path("hill.npy"))
        assert DESIGN.run(DESIGN.presets["catenoid-8x6"]).folded is not None


def test_values_that_name_no_file_are_refused(tmp_path: Path) -> None:
    for kind in ("height-field", "mesh"):
        with pytest.raises(InvalidParameters, match=r"say which by surface\.file"):
            DESIGN.validate({"surface": {"kind": kind}})
        with pytest.raises(InvalidParameters, match="there is no file"):
            params(kind, tmp_path)
    with pytest.raises(InvalidParameters, match="sha256"):
        params("mesh", saved(tmp_path, ".npy"), sha256="abc")
    for name, value in (("nodes", 3), ("nodes", 201), ("relief", 1.1), ("relief", float("nan"))):
        with pytest.raises(InvalidParameters, match=rf"surface\.{name}"):
            params("height-field", saved(tmp_path, ".npy"), **{name: value})


def test_a_peak_too_steep_is_never_called_well(tmp_path: Path) -> None:
    x, y = np.mgrid[-1:1:41j, -1:1:41j]
    np.save(tmp_path / "peak.npy", np.exp(-6 * (x**2 + y**2)))
    with pytest.raises(ImpossibleGeometry, match="times as deep as their cells are high"):
        DESIGN.run(params("height-field", tmp_path / "peak.npy", relief=0.6, n_u=16, n_v=16))


Place = Callable[[np.ndarray, np.ndarray], tuple[np.ndarray, np.ndarray, np.ndarray]]


def grid(n: int, place: Place, *, side: float = 1.0) -> tuple[np.ndarray, np.ndarray]:
    """Return points and triangles of n × n places over [-side, side]²."""
    u, v = (each.ravel() for each in np.meshgrid(*[np.linspace(-side, side, n)] * 2, indexing="ij"))
    number = np.arange(n * n).reshape(n, n)
    a, b, c, d = (
        number[:-1, :-1].ravel(),
        number[1:, :-1].ravel(),
        number[1:, 1:].ravel(),
        number[:-1, 1:].ravel(),
    )
    faces = np.vstack([np.column_stack([a, b, c]), np.column_stack([a, c, d])])
    return np.column_stack(place(u, v)), faces


def export(file: Path, points: np.ndarray, faces: np.ndarray) -> Path:
    import trimesh

    trimesh.Trimesh(points, faces, process=False).export(file)
    return file


def saddle(u: np.ndarray, v: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    return u, v, 0.4 * (u * u - v * v)


@pytest.mark.parametrize("suffix", [".obj", ".stl", ".ply", ".off"])
def test_a_mesh_folds_as_the_surface_it_was_taken_from(suffix: str, tmp_path: Path) -> None:
    file = export(tmp_path / f"saddle{suffix}", *grid(31, saddle))
    fold = DESIGN.run(params("mesh", file, n_u=12, n_v=12))
    assert fold.meta["status"]["verdicts"] == ["ok"]
    target = params("mesh", file).surface.surface()
    u, v = np.random.default_rng(5).uniform(-1, 1, (2, 200))
    x, y, z = target.points(u, v).T
    assert np.abs(z - saddle(x, y)[2]).max() < 0.002
    for axis in (x, y):  # the sharpest corners of the mesh are those of the square
        assert np.abs(axis).max() > 0.9


def test_the_front_of_a_mesh_is_the_front_of_the_target(tmp_path: Path) -> None:
    points, faces = grid(15, saddle)
    for turned, sign in ((faces, 1), (faces[:, ::-1], -1)):
        file = export(tmp_path / "saddle.ply", points, turned)
        jet = params("mesh", file).surface.surface().jet(np.zeros(1), np.zeros(1))
        assert np.sign(jet.cross[0, 2]) == sign


def test_a_map_to_the_square_turns_no_triangle_over_and_keeps_flat_squares() -> None:
    points, faces = grid(13, lambda u, v: (u, v, 0 * u))
    uv = Disk.of(points, faces).over_square()
    centre = uv - uv.mean(axis=0)
    turn = np.linalg.lstsq(points[:, :2], centre, rcond=None)[0]
    assert points[:, :2] @ turn == pytest.approx(centre, abs=1e-12)
    assert turn @ turn.T == pytest.approx(np.eye(2), abs=1e-12)
    rng = np.random.default_rng(8)
    crumpled = points + rng.normal(scale=0.02, size=points.shape)
    corners = Disk.of(crumpled, faces).over_square()[faces]
    one, two = corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
    assert (one[:, 0] * two[:, 1] > one[:, 1] * two[:, 0]).all()


def test_a_round_disk_has_its_corners_at_the_quarters(tmp_path: Path) -> None:
    import trimesh

    cap = trimesh.creation.icosphere(subdivisions=4).slice_plane([0, 0, 0.5], [0, 0, 1])
    file = tmp_path / "cap.ply"
    cap.export(file)
    asked = params("mesh", file, n_u=16, n_v=16, start="uniform")
    assert DESIGN.run(asked).meta["status"]["verdicts"] == ["ok"]
    corners = Build(asked).surface.points(np.array([-1.0, 1, 1, -1]), np.array([-1.0, -1, 1, 1]))
    assert corners[:, 2] == pytest.approx(0.5, abs=0.02)
    assert np.linalg.norm(corners - np.roll(corners, 1, axis=0), axis=1) == pytest.approx(
        np.sqrt(1.5), rel=0.05
    )


@pytest.mark.parametrize(
    ("name", "said"),
    [
        ("ball", "is closed: it has no border"),
        ("hole", "has 2 borders; a disk has one"),
        ("two", "is in 2 pieces"),
        ("fin", "edges with more than two triangles"),
        ("strip", "turn against each other"),
        ("bow", "is in 2 pieces|touches itself at a point"),
        ("handle", "has a handle"),
        ("coarse", "triangles: too coarse"),
        ("spikes", "the smooth surface through the mesh"),
    ],
)
def test_a_mesh_that_is_no_disk_is_refused_with_what_it_is(
    name: str, said: str, tmp_path: Path
) -> None:
    file = export(tmp_path / "mesh.ply", *SHAPES[name]())
    with pytest.raises(ImpossibleGeometry, match=said):
        DESIGN.run(params("mesh", file))


def test_a_mesh_does_not_lose_the_triangles_at_a_corner_that_is_nowhere(tmp_path: Path) -> None:
    points, faces = grid(12, saddle)
    points[14] = np.nan  # next to the border: without its triangles a disk would be left
    file = export(tmp_path / "mesh.ply", points, faces)
    with pytest.raises(ImpossibleGeometry, match="corner 15 is at no finite place"):
        DESIGN.run(params("mesh", file))


def ball() -> tuple[np.ndarray, np.ndarray]:
    import trimesh

    mesh = trimesh.creation.icosphere(subdivisions=3)
    return np.asarray(mesh.vertices), np.asarray(mesh.faces)


def hole() -> tuple[np.ndarray, np.ndarray]:
    points, faces = grid(15, saddle)
    is_near = np.abs(points[:, :2]).max(axis=1) < 0.2
    return points, faces[~is_near[faces].any(axis=1)]


def two() -> tuple[np.ndarray, np.ndarray]:
    points, faces = grid(8, saddle)
    return np.vstack([points, points + 5]), np.vstack([faces, faces + len(points)])


def fin() -> tuple[np.ndarray, np.ndarray]:
    points, faces = grid(15, saddle)
    return np.vstack([points, [[0, 0, 3]]]), np.vstack([faces, [[100, 115, len(points)]]])


def strip() -> tuple[np.ndarray, np.ndarray]:
    """A Möbius strip: its last column is its first, upside down."""
    points, faces = grid(15, lambda u, v: (u, v, 0 * u))
    u, v = points[:, 0] * np.pi, points[:, 1] / 2
    r = 2 + v * np.cos(u / 2)
    number = np.arange(225).reshape(15, 15)
    number[-1] = number[0, ::-1]
    return np.column_stack([r * np.cos(u), r * np.sin(u), v * np.sin(u / 2)]), number.ravel()[faces]


def bow() -> tuple[np.ndarray, np.ndarray]:
    points, faces = grid(8, saddle)
    return np.vstack([points, points + (points[-1] - points[0])]), np.vstack(
        [faces, faces + len(points)]
    )


def handle() -> tuple[np.ndarray, np.ndarray]:
    """A torus without one triangle."""
    import trimesh

    mesh = trimesh.creation.torus(2, 0.7, 12, 12)
    return np.asarray(mesh.vertices), np.asarray(mesh.faces)[1:]


def coarse() -> tuple[np.ndarray, np.ndarray]:
    return grid(4, saddle)


def spikes() -> tuple[np.ndarray, np.ndarray]:
    points, faces = grid(21, saddle)
    points[220, 2] += 2
    return points, faces


SHAPES = {
    each.__name__: each for each in (ball, hole, two, fin, strip, bow, handle, coarse, spikes)
}


@pytest.mark.parametrize("suffix", [".obj", ".stl", ".ply", ".off"])
def test_a_mesh_promises_about_as_many_triangles_as_it_has(suffix: str, tmp_path: Path) -> None:
    file = export(tmp_path / f"saddle{suffix}", *grid(31, saddle))
    assert 0.4 * 1800 < promised(file.read_bytes(), suffix) <= 1800


@pytest.mark.parametrize(
    ("name", "content"),
    [
        ("a.obj", b"v 0 0 0\n" + b"f 1 2 3\n" * (MOST_FACES + 1)),
        ("a.obj", b"v 0 0 0\nf" + b" 1" * 10 * (MOST_FACES + 1)),
        ("a.stl", b"\0" * (84 + 50 * (MOST_FACES + 1))),
        ("a.stl", b"solid x\n" + b"endfacet\n" * (MOST_FACES + 1)),
        ("a.ply", b"ply\nformat ascii 1.0\nelement vertex 3\nelement face 999999999999\n"),
        ("a.off", b"OFF\n999999999 1 0\n"),
    ],
)
def test_a_mesh_with_too_many_triangles_is_refused_unread(
    name: str, content: bytes, tmp_path: Path
) -> None:
    (tmp_path / name).write_bytes(content)
    with pytest.raises(ImpossibleGeometry, match="triangles or more; take at most 200000"):
        DESIGN.run(params("mesh", tmp_path / name))


@pytest.mark.parametrize(
    ("name", "content"),
    [
        ("a.stl", b"solid x\nnonsense"),
        ("a.obj", b"v 1 2 3\n"),
        ("a.ply", b"ply\nformat"),
        ("a.off", b"OFF\n1"),
        ("a.obj", b"v nan 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"),
        ("a.stl", b""),
    ],
)
def test_a_broken_mesh_is_refused_and_nothing_else_is_raised(
    name: str, content: bytes, tmp_path: Path
) -> None:
    (tmp_path / name).write_bytes(content)
    with pytest.raises(FoldmillError, match=r"a\.(stl|obj|ply|off)|too coarse"):
        DESIGN.run(params("mesh", tmp_path / name))


@pytest.mark.parametrize(
    ("lines", "said"),
    [
        ("v 1 2 3", r'it holds 1 corners .* and 0 facets \(lines "f a b c"\)'),
        ("", "it holds 0 corners"),
        (
            "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 9",
            r"line 4 \(f 1 2 9\) names corner 9, and there are 3",
        ),
        ("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 -4", "line 4 .* names corner -4, and there are 3"),
        (
            "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 x 3",
            r"line 4 \(f 1 x 3\) holds something that is no num",
        ),
        ("v 0 0 0\nv 1 0\nv 0 1 0\nf 1 2 3", r"line 2 \(v 1 0\) has 2 coordinates, not 3"),
        ("v 0 0 0\nv 1 0 zz\nv 0 1 0\nf 1 2 3", r"line 2 \(v 1 0 zz\) holds something"),
        (
            "# a\nv nan 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3",
            r"line 2 \(v nan 0 0\) is at no finite place",
        ),
    ],
)
def test_what_is_wrong_with_an_obj_file_is_told_with_its_line_and_what_to_do(
    lines: str, said: str, tmp_path: Path
) -> None:
    (tmp_path / "a.obj").write_text(lines)
    with pytest.raises(
        ImpossibleGeometry, match=rf"a\.obj is no \.obj .*{said}.* Save the mesh again"
    ):
        DESIGN.run(params("mesh", tmp_path / "a.obj"))
