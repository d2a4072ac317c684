"""Designs found by their derivatives: objectives, constraints, and `optimize`.

best = jk.optimize(
    jk.design.path("coupler", (30, 60, 0), targets),
    mechanism,
    drive={"A": angles},
    lengths={("coupler", "B", "C"): (2.0, 5.0)},
)
best.mechanism, best.value, best.history
"""

from jaxkin.design.bounds import Free as Free
from jaxkin.design.clearance import clearance as clearance
from jaxkin.design.constraints import above as above
from jaxkin.design.constraints import apart as apart
from jaxkin.design.constraints import full_crank as full_crank
from jaxkin.design.constraints import grashof as grashof
from jaxkin.design.constraints import in_box as in_box
from jaxkin.design.constraints import in_sequence as in_sequence
from jaxkin.design.constraints import transmission_within as transmission_within
from jaxkin.design.measures import stroke as stroke
from jaxkin.design.measures import transmission_angle as transmission_angle
from jaxkin.design.objective import Objective as Objective
from jaxkin.design.objectives import dwell as dwell
from jaxkin.design.objectives import function as function
from jaxkin.design.objectives import guidance as guidance
from jaxkin.design.objectives import path as path
from jaxkin.design.objectives import stroke_of as stroke_of
from jaxkin.design.objectives import transmission as transmission
from jaxkin.design.optimisers import LBFGS as LBFGS
from jaxkin.design.optimisers import LevenbergMarquardt as LevenbergMarquardt
from jaxkin.design.optimize import optimize as optimize
from jaxkin.design.result import Optimum as Optimum
from jaxkin.design.result import read_optimum as read_optimum
from jaxkin.design.shapes import bar as bar
from jaxkin.design.shapes import solid as solid
