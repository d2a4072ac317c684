"""Effects of a motion, each a plain function of it: what is not called costs nothing.

Each line names first the module of the function that users call.

- `rates` (velocities, accelerations, jerks), `screw_axes` of them; `motion_law` gives displacements over time.
- `coupler_curve`: the path of a point, over a `curve_range`, with its `cusps_crossings`.
- `limits`: how far a drive goes. `limit_search` follows a `motion_curve` past the poses in which the drive locks;
  `limits_result` is what it finds, of which `limit_of_design` takes each limit to other designs, with derivatives.
- `assembly_modes`: all closed poses of some inputs, by `mode_search`; `coupled_turns` are modes of their own.
- `workspace`: a map over two inputs. `grid_flood` fills it by `grid_steps`; `singularities` are where it ends.
- `mode_regions`: which modes a path over two inputs connects, by the same steps on several `sheets`.
- `clashes`: where parts cut each other. `clash_shapes` are their solids, `clash_cases` what differs of their pairs and
  poses, which `clash_search` searches; `penetration` and `sampled_depths` measure, and `invariant_faces` are left out;
  `clash_progress` tells how far it is.
- `contact_validity`: where the faces of contacts part. `curve_contacts`: where followers of curves cannot be, of
  each `curve_contact` and `surface_contact`.
- `swept_volume`: the space that a part takes up, over its `pose_runs`.
- `tolerances`: what each `tolerance` and `pin_play` does to a measure, by a `design_batch`; see `tolerance_result`.
- `calibrate`: `calibration_unknowns` from `calibration_data`, by a `rank_deficient_fit`; see `calibration_result`.
- `accuracy`: time against error, which poses in `extended` precision tell.
- `forces`: of drives, in joints, and in equilibrium.

`determined_drive` refuses drives that leave freedoms, of all that search for poses, and finds where these begin.
Modules whose names end in `_plot` draw, and `pose_plot` saves, too.
"""
