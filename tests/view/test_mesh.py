import numpy as np
import trimesh

from jaxkin.view.mesh import shaded_mesh


def test_a_box_has_twelve_edges_and_three_normals_at_every_corner():
    mesh = shaded_mesh(trimesh.creation.box((1.0, 0.6, 0.3)).triangles.view(np.ndarray))
    assert len(mesh.points) == 24 and len(mesh.triangles) == 12
    assert np.allclose(np.sort(np.abs(mesh.normals), axis=1), [0, 0, 1], atol=1e-12)
    lengths = np.linalg.norm(mesh.edges[:, 0] - mesh.edges[:, 1], axis=1)
    assert np.allclose(np.sort(lengths), np.repeat([0.3, 0.6, 1.0], 4))  # none of the diagonals


def test_a_ball_is_smooth():
    mesh = shaded_mesh(trimesh.creation.icosphere(3, 0.5).triangles.view(np.ndarray))
    assert len(mesh.edges) == 0 and len(mesh.points) == 642
    # a facet of this ball is 0.14 radii wide: its corner's normal is the radius to within the square of that
    assert np.allclose(mesh.normals, 2 * mesh.points, atol=0.02)


def test_the_rim_of_an_open_sheet_is_an_edge():
    sheet = np.array([[[0.0, 0, 0], [1, 0, 0], [1, 1, 0]], [[0, 0, 0], [1, 1, 0], [0, 1, 0]]])
    assert len(shaded_mesh(sheet).edges) == 4


def test_the_triangles_are_those_given():
    triangles = trimesh.creation.cylinder(0.3, 1.0, sections=40).triangles.view(np.ndarray)
    mesh = shaded_mesh(triangles)
    drawn = mesh.points[mesh.triangles]
    keys = [np.sort(t.reshape(len(t), 9).round(6), axis=0) for t in (np.sort(triangles, 1), np.sort(drawn, 1))]
    assert np.allclose(*keys)
    assert len(mesh.edges) == 80
