"""Solids in their assembled pose, and how they become a mechanism.

The route is told on the page "Architecture". What the modules do on it:

| step | modules |
|---|---|
| what the user holds, and asks for | `assembly`, `ignored_contacts` |
| contacts, inferences and joints by hand become a mechanism | `to_mechanism`, `joined` |
| what the file says of its joints | `exported`, `close_export`, `from_export`, `joints_of_two`; `subassemblies` |
| what solids imply beside exact contacts | `inference`, tried by `with_inferences` (`trials`, `dropped_inference`) |
| bodies held to each other, where all else moves | `seats`, `guides`, `resting`, `lids`, `tight_fits`, `hinge_bores` |
| valves that leave their seats, where nothing moves else | `lifting_seats` |
| joints that may be none, since what they tie fits exactly | `exact_fits` |
| parts that only spin, and those of them that are drawn to turn | `spinning`, `needless`, `at_rest`, `meant_to_turn` |
| mechanisms of joints by hand alone: parts that nothing ties, faces in contact | `left_loose`, `kept_contacts` |
| notes for the user | `near_misses`, `caps`, `undrawn_shafts` |

Asked for by users, of an assembly or a mechanism: what to fix and drive (`proposals`, `wheels`), which contacts lock it
(`blocking_contacts`), which inferences do (`taken_back`), and gears (`gears`, `gear_proposal`, `toothed_parts`,
`racks`).
"""
