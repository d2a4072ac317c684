"""Poses, the paper's movements, surfaces, faces and parts. No module here knows of contacts or joints.

| what | modules |
|---|---|
| poses and displacements | `pose` (numpy, one), `rigid` (JAX, many), `displaced` (numpy, many), `screw_motion` |
| movements | `movements`, rows of `movement`, made of `elementary_motions`; `chains`, `partial_movement`, |
| | `figures` (what is drawn) |
| what joints follow | `curves` (profiles), `patches` (surfaces) |
| parts | `part` (with faces), `surfaces` (the four of the paper), `torus`, `inertial`, `units`, `headings` of tables |
| faces of meshes | `weld` and `stitch` (corners), `shells` (solids), `facets`, `regions` (faces), `region_growing`, |
| | `region_union`, `tessellation_test`, `merge` |
| fits of surfaces to points | `fit`, `refine` (its steps), `fit_together`, `fit_uncertainty` |
| distances and crossings of solids | `triangle_tree`, `solid_pairs` (many together), `tree_distances`, |
| | `tree_crossings`, `node_boxes`, `pose_intervals`, `triangle_distance`, `hull_distance`, `sample_points`, |
| | `enclosed`, `congruent` |
| the same in JAX, differentiable | `closest_points`, of `mesh_elements` |
| swept volumes | `signed_distance`, `isosurface` |
| gears | `teeth`, `tooth_rows`, `outline` |

`triangles`, `components`, `characteristic_length`, `trig`, `root` and `affine` serve several of these.
"""
