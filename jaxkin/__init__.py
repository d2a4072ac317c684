"""jaxkin: differentiable kinematics of closed-loop mechanisms, from solid models to joints, loops and motion.

assembly = jk.load("fourbar.step")
mechanism = assembly.mechanism(fixed=["ground"])
motion = mechanism.sweep({"ground-crank": jnp.linspace(0, 2 * jnp.pi, 361)})
motion.save("out/")
"""

from jaxkin import design as design
from jaxkin.assembly.assembly import Assembly as Assembly
from jaxkin.design.optimize import optimize as optimize
from jaxkin.effects.accuracy import work_precision as work_precision
from jaxkin.effects.rates import accelerations as accelerations
from jaxkin.effects.rates import velocities as velocities
from jaxkin.io.load import load as load
from jaxkin.io.study import load_study as load_study
from jaxkin.joints.joint import Joint as Joint
from jaxkin.joints.pairs import contact_joint as contact_joint
from jaxkin.joints.pairs import cylindrical as cylindrical
from jaxkin.joints.pairs import fixed as fixed
from jaxkin.joints.pairs import planar as planar
from jaxkin.joints.pairs import prismatic as prismatic
from jaxkin.joints.pairs import revolute as revolute
from jaxkin.joints.pairs import screw as screw
from jaxkin.joints.pairs import spherical as spherical
from jaxkin.joints.pairs import universal as universal
from jaxkin.mechanism.lost_contacts import LostContact as LostContact
from jaxkin.mechanism.mechanism import Mechanism as Mechanism
from jaxkin.mechanism.motion import Motion as Motion
from jaxkin.mechanism.pose_error import PoseError as PoseError
from jaxkin.mechanism.reassembly import Move as Move
from jaxkin.mechanism.reassembly import Reassembly as Reassembly
from jaxkin.mobility.open_loops import Opening as Opening
from jaxkin.solve.options import SolverOptions as SolverOptions
from jaxkin.solve.status import Status as Status
from jaxkin.view import structure as _structure

del _structure

__version__ = "0.1.0"
