"""Pictures (PNG) and pages for the browser (HTML).

| what | modules |
|---|---|
| the picture of a motion | `storyboard`, on a `sheet`; drawn by `illustration`, hidden surfaces by `raster` |
| the chart of a motion | `coordinates_plot` |
| the page of a motion | `page` (`page.html`, `page.js`) |
| what both show of a motion | `scene`: `camera` (the view), `traces` (paths), `lost_marks`, `labels` |
| pictures of an assembly | `inspection`, `gallery` (each contact alone); `glass`, `regions`, `callouts` |
| the page of an assembly | `inspection_page` (`inspection.html`, `inspection.js`) |
| what pages share | `viewer` (`viewer.js`, `mouse.js`, `viewer.css`), `mesh` |
| parts, and what stands for them | `drawing` (colours), `sticks`, `curve_figures` |
| the drawing of a structure | `structure`: `graph`, with `layout`, and `tree` |
"""
