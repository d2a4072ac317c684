"""The sixteen contact states of the paper as a table, and how they are found between solids.

| what | modules |
|---|---|
| the states | `states`; where two surfaces touch: `touch`, with cones `rulings`; frames of Table 1: `frames` |
| detection | `detect`; boxes that overlap: `boxes`; within which lengths and angles: `tolerance` |
| the region on both faces | `region`, with `overlap`, `unrolled` (cylinders and cones), `intervals`, `rim` |
| what is nearly a contact | `reason`, `remedy` (tolerances that help), `slots` (pins with play), `edges` |
| faces that part while a mechanism moves | `separation`, with `extent` and `hulls`; exactly at one pose `whole_face` |

What is found is in `contact`, each a Contact.
"""
