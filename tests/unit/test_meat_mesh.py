"""Meat from a user's mesh: what is read, and what is refused and how."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.testing import assert_allclose

from sims.cutting.meat import Meat
from sims.cutting.meat.crossing import crossing
from sims.cutting.meat.meshfile import read_surface
from sims.cutting.meat.surface import Surface
from wbc.errors import InputError

HALF = np.array([0.14, 0.10, 0.045])  # of a blob [m]


def blob(
    half=HALF, rings: int = 16, power: float = 0.5
) -> tuple[np.ndarray, np.ndarray]:
    """A rounded box as a grid of longitudes and latitudes about x."""
    latitude = np.linspace(-np.pi / 2, np.pi / 2, rings + 1)[1:-1]
    longitude = np.linspace(0, 2 * np.pi, 2 * rings, endpoint=False)

    def soft(s):
        return np.sign(s) * np.abs(s) ** power

    a, b = np.meshgrid(latitude, longitude, indexing="ij")
    sides = [
        soft(np.sin(a)),
        soft(np.cos(a)) * soft(np.cos(b)),
        soft(np.cos(a)) * soft(np.sin(b)),
    ]
    vertices = np.stack(sides, axis=-1).reshape(-1, 3)
    vertices = np.vstack([vertices, [[-1, 0, 0], [1, 0, 0]]]) * half
    n, m = len(latitude), len(longitude)
    faces = []
    for j in range(m):
        k = (j + 1) % m
        faces += [[n * m, j, k], [n * m + 1, (n - 1) * m + k, (n - 1) * m + j]]
        for i in range(n - 1):
            p, q, r, s = i * m + j, i * m + k, (i + 1) * m + j, (i + 1) * m + k
            faces += [[p, r, q], [q, r, s]]
    return vertices, np.array(faces)


def write_obj(path, vertices, faces, form="{}"):
    lines = [f"v {x} {y} {z}" for x, y, z in vertices.tolist()]
    lines += ["f " + " ".join(form.format(i + 1) for i in face) for face in faces]
    path.write_text("\n".join(["# a comment", "o meat", *lines]))
    return path


def write_stl(path, vertices, faces, binary: bool):
    corners = vertices[faces]
    if binary:
        kind = np.dtype([("n", "<f4", 3), ("c", "<f4", (3, 3)), ("s", "<u2")])
        facets = np.zeros(len(faces), kind)
        facets["c"] = corners
        size = np.array([len(faces)], "<u4").tobytes()
        path.write_bytes(b"solid but binary".ljust(80) + size + facets.tobytes())
        return path
    text = "solid meat\n"
    for facet in corners.tolist():
        points = "".join(f"vertex {x} {y} {z}\n" for x, y, z in facet)
        text += f"facet normal 0 0 0\nouter loop\n{points}endloop\nendfacet\n"
    path.write_text(text + "endsolid meat\n")
    return path


def test_every_file_format_gives_the_same_surface(tmp_path):
    vertices, faces = blob()
    expected = Surface(vertices, faces)
    for path in (
        write_obj(tmp_path / "a.obj", vertices, faces),
        write_obj(tmp_path / "b.OBJ", vertices, faces, "{0}/{0}/{0}"),
        write_stl(tmp_path / "c.stl", vertices, faces, binary=True),
        write_stl(tmp_path / "d.stl", vertices, faces, binary=False),
    ):
        surface = read_surface(path)
        assert len(surface.vertices) == len(vertices)
        assert surface.volume == pytest.approx(expected.volume, rel=1e-5)


def test_volume_counts_outwards_however_the_file_is_wound():
    vertices, faces = blob()
    box = 8 * np.prod(HALF)
    for winding in (faces, faces[:, ::-1]):
        assert 0.5 * box < Surface(vertices, winding).volume < box


def test_meat_of_a_mesh_stands_on_the_table_with_its_seam_in_place(tmp_path):
    vertices, faces = blob(1000 * HALF)
    path = write_obj(tmp_path / "mm.obj", vertices + np.array([500, -3000, 70]), faces)
    meat = Meat.from_mesh(
        path,
        lambda x, z: -3.0 + 0.3 * (x - 0.5) ** 2 + 0.1 * (z - 0.07),
        scale=0.001,
        place=(0.5, 0.14),
    )
    seam = meat.sheets.seam
    assert seam[..., 2].min() == pytest.approx(0.27)
    assert 0.5 * (seam[0, 0, 0] + seam[-1, 0, 0]) == pytest.approx(0.5)
    held, pulled = meat.sheets.muscles()
    assert held.volume + pulled.volume == pytest.approx(
        Surface(vertices / 1000, faces).volume, rel=0.12
    )
    x, y, z = seam.reshape(-1, 3).T
    z0 = 0.27 + 0.5 * (seam[8, -1, 2] - seam[8, 0, 2])
    assert_allclose(y - y[59], 0.3 * (x - 0.5) ** 2 + 0.1 * (z - z[59]), atol=1e-9)
    assert abs(z0 - z[59]) < 0.01


def test_seam_is_an_upright_plane_unless_said_otherwise(tmp_path):
    meat = Meat.from_mesh(write_obj(tmp_path / "a.obj", *blob()))
    assert_allclose(meat.sheets.seam[..., 1], meat.sheets.seam[0, 0, 1])
    assert meat.links.area.sum() == pytest.approx(0.28 * 0.09, rel=0.2)


def test_an_open_mesh_is_refused_with_the_place_of_the_hole(tmp_path):
    vertices, faces = blob()
    path = write_obj(tmp_path / "a.obj", vertices, faces[1:])
    with pytest.raises(InputError, match=r"a\.obj.*open: 3 edges.*-0\.1"):
        Meat.from_mesh(path)


def test_a_mesh_that_crosses_itself_is_refused_with_the_place(tmp_path):
    vertices, faces = blob()
    vertices[len(vertices) // 2] *= [1.0, -1.5, -1.5]  # a spike through the other side
    with pytest.raises(InputError, match="crosses itself near"):
        Meat.from_mesh(write_obj(tmp_path / "a.obj", vertices, faces))


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (lambda v, f: (v, np.vstack([f, f[:1]])), "more than two"),
        (lambda v, f: (v, np.vstack([f[1:], f[:1, ::-1]])), "wound both ways"),
        (
            lambda v, f: (np.vstack([v, v + 1.0]), np.vstack([f, f + len(v)])),
            "2 pieces",
        ),
        (lambda v, f: (1000 * v, f), "millimetres"),
        (lambda v, f: (v[:, [1, 0, 2]], f[:, ::-1]), None),
    ],
)
def test_meshes_that_are_no_meat_are_refused(tmp_path, change, message):
    path = write_obj(tmp_path / "a.obj", *change(*blob()))
    if message is None:
        Meat.from_mesh(path)  # turned by a quarter, but still meat
        return
    with pytest.raises(InputError, match=message):
        Meat.from_mesh(path)


@pytest.mark.parametrize(
    "seam",
    [
        lambda x, z: 0.2 + 0 * x,  # beside it
        lambda x, z: 1.5 * x,  # out of its side after a part of the length
        lambda x, z: 4.0 * z,  # out of its side at a part of the height
    ],
)
def test_a_cutting_surface_outside_the_meat_is_refused(tmp_path, seam):
    path = write_obj(tmp_path / "a.obj", *blob())
    with pytest.raises(InputError, match="cutting surface is outside the meat"):
        Meat.from_mesh(path, seam)


@pytest.mark.parametrize("seam", [lambda x, z: x / 0, lambda x, z: x[:3]])
@pytest.mark.filterwarnings("ignore:(divide|invalid):RuntimeWarning")
def test_a_cutting_surface_that_is_none_is_refused(tmp_path, seam):
    with pytest.raises(InputError, match="finite numbers"):
        Meat.from_mesh(write_obj(tmp_path / "a.obj", *blob()), seam)


@pytest.mark.parametrize(
    ("name", "content", "message"),
    [
        ("a.ply", b"ply", r"not an \.stl or \.obj"),
        ("a.obj", None, "no mesh file"),
        ("a.obj", b"v 0 0\n", "cannot be read"),
        ("a.obj", b"v 0 0 x\n", "cannot be read"),
        ("a.obj", b"v 0 0 0\nf 1 2 3\n", "vertex 2 of 1"),
        ("a.obj", b"v 0 0 0\n", "no triangles"),
        ("a.stl", b"\xff\xfe", "cannot be read"),
        ("a.stl", b"solid a\nvertex 0 0 0\n", "three corners"),
        ("a.stl", b"solid a\nendsolid a\n", "no triangles"),
        ("a.obj", b"v 0 0 0\nv nan 0 0\nv 0 1 0\nf 1 2 3\n", "finite"),
    ],
)
def test_files_that_are_no_mesh_are_refused(tmp_path, name, content, message):
    if content is not None:
        (tmp_path / name).write_bytes(content)
    with pytest.raises(InputError, match=message):
        Meat.from_mesh(tmp_path / name)


def test_crossing_is_found_and_touching_is_not_crossing():
    base = np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0]])
    through = np.array([[0.2, 0.2, -1], [0.2, 0.2, 1], [0.3, 0.2, 1]])
    corner = np.array([[0.2, 0.2, 0], [0.2, 0.2, 1], [0.3, 0.2, 1]])
    neighbour = np.array([[0.0, 0, 0], [0, 1, 0], [-1, 0, 0.5]])
    apart = base + np.array([0, 0, 2.0])
    assert crossing(np.array([base, apart, through])) == (0, 2)
    assert crossing(np.array([base, corner, neighbour, apart])) is None


def test_no_crossing_is_missed_by_the_sweep():
    rng = np.random.default_rng(0)
    for _ in range(20):
        corners = rng.uniform(size=(12, 1, 3)) + 0.3 * rng.normal(size=(12, 3, 3))
        pairs = [(i, j) for i in range(12) for j in range(i)]
        alone = any(crossing(corners[[i, j]]) is not None for i, j in pairs)
        assert (crossing(corners) is not None) == alone
