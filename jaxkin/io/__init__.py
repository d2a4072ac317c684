"""Files in and out. `load` reads assemblies of all formats, `writers` lists what motions are saved as.

| what | read by | written by |
|---|---|---|
| STEP | `step`, with `step_solid` and the other `step_...` | |
| meshes | `mesh`, `mesh_nodes`, `mesh_check`, `mesh_regions`, `threemf_reader`, `glb_reader`, `obj_faces` | |
| exports of CAD systems for Simscape Multibody | `exports`, `simscape`, and the `export_...` | |
| robots, all formats | `robot_files`, `robots`, `robot_model` and the other `robot_...`, `shape_masses` | `writable`, |
| | | `written_masses`, `single_motions` |
| URDF | `urdf`, `robot_loops` | `urdf_writer` |
| MJCF | `mjcf`, and the `mjcf_...` | `mjcf_writer` |
| SDF | `sdf`, and the `sdf_...` | |
| FreeCAD, its solver | `fcstd`, `fcstd_document`, `asmt`, `marker_joints`, `marker_ties` | `asmt_writer`,
| | | `asmt_joints`, `asmt_ties` |
| studies | `study`, `study_file` and the other `study_...`, `ranges`, `named_effects` | `study_writer` |
| mechanisms | `saved_mechanism` | `mechanism_file` |
| motions | | `writers`, `tables`, `gltf`; of any length `long_motion` |

Files of unknown origin are read within bounds: in processes of their own (`sandbox`, `guardian`, `time_limit`,
`step_convert`, `step_worker`, `mesh_worker`), or by readers of few words (`xml_tree`, `yaml_subset`). `names`,
`numbers`, `toml_text` and `gltf_colors` are about single values, `odd_sizes` about parts of another unit.
"""
