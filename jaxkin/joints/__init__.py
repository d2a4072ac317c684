"""Joints as chains of movements: written by hand, from single contacts, and from several contacts combined.

| what | modules |
|---|---|
| a joint | `joint`, `kinds`, `limits`, `evidence` (what it is known from), `screws` (its displacements and twists) |
| joints by hand | `pairs`, `sliding_joints`, with `axis_frame`; by a frame on each part: `on_frames`, `two_frames` |
| along curves, over surfaces | `curve_joints`, `profile_plane`, `profiles`; `surface_joints`, `patch_contact` |
| from contacts of solids | `from_contacts`, `combine` (to one subgroup joint), `mates` (of CAD systems) |
| without the noise of files | `regularise`, `directions`, `axes`; how large it is: `file_noise` |
| between joints | `coupling` |
| of a loop | `subgroups` |
"""
