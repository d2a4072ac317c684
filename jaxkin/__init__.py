"""jaxkin: differentiable kinematics of closed-loop mechanisms, from solid models to joints, loops and motion.

assembly = jk.load("fourbar.step")
mechanism = assembly.mechanism(fixed=["ground"])
motion = mechanism.sweep({"ground-crank": jnp.linspace(0, 2 * jnp.pi, 361)})
motion.save("out/")
"""

from jaxkin import design as design
from jaxkin.assembly.assembly import Assembly as Assembly
from jaxkin.assembly.blocking_contacts import BlockingContacts as BlockingContacts
from jaxkin.assembly.proposals import Proposal as Proposal
from jaxkin.contacts.contact import Contact as Contact
from jaxkin.contacts.contact import Contacts as Contacts
from jaxkin.contacts.states import CONTACT_STATES as CONTACT_STATES
from jaxkin.contacts.states import ContactState as ContactState
from jaxkin.design.optimize import optimize as optimize
from jaxkin.design.result import Optimum as Optimum
from jaxkin.effects.accuracy import WorkPrecision as WorkPrecision
from jaxkin.effects.accuracy import work_precision as work_precision
from jaxkin.effects.assembly_modes import AssemblyMode as AssemblyMode
from jaxkin.effects.assembly_modes import AssemblyModes as AssemblyModes
from jaxkin.effects.assembly_modes import assembly_modes as assembly_modes
from jaxkin.effects.clashes import Clashes as Clashes
from jaxkin.effects.clashes import clashes as clashes
from jaxkin.effects.contact_validity import ContactValidity as ContactValidity
from jaxkin.effects.contact_validity import contact_validity as contact_validity
from jaxkin.effects.limit_search import LimitKind as LimitKind
from jaxkin.effects.limits import Limit as Limit
from jaxkin.effects.limits import Limits as Limits
from jaxkin.effects.limits import limits as limits
from jaxkin.effects.motion_law import MotionLaw as MotionLaw
from jaxkin.effects.motion_law import motion_law as motion_law
from jaxkin.effects.rates import Rates as Rates
from jaxkin.effects.rates import accelerations as accelerations
from jaxkin.effects.rates import jerks as jerks
from jaxkin.effects.rates import velocities as velocities
from jaxkin.effects.screw_axes import ScrewAxes as ScrewAxes
from jaxkin.effects.screw_axes import screw_axes as screw_axes
from jaxkin.effects.singularities import Singularities as Singularities
from jaxkin.effects.singularities import singularities as singularities
from jaxkin.effects.workspace import Workspace as Workspace
from jaxkin.effects.workspace import workspace as workspace
from jaxkin.geometry.part import Part as Part
from jaxkin.io.load import load as load
from jaxkin.io.study import Study as Study
from jaxkin.io.study import load_study as load_study
from jaxkin.io.study_writer import write_study as write_study
from jaxkin.joints.coupling import Coupling as Coupling
from jaxkin.joints.coupling import belt as belt
from jaxkin.joints.coupling import differential as differential
from jaxkin.joints.coupling import gear as gear
from jaxkin.joints.coupling import polynomial as polynomial
from jaxkin.joints.coupling import rack as rack
from jaxkin.joints.coupling import relation as relation
from jaxkin.joints.evidence import Bond as Bond
from jaxkin.joints.evidence import Evidence as Evidence
from jaxkin.joints.evidence import EvidenceKind as EvidenceKind
from jaxkin.joints.joint import Joint as Joint
from jaxkin.joints.pairs import contact_joint as contact_joint
from jaxkin.joints.pairs import cylindrical as cylindrical
from jaxkin.joints.pairs import fixed as fixed
from jaxkin.joints.pairs import free as free
from jaxkin.joints.pairs import planar as planar
from jaxkin.joints.pairs import prismatic as prismatic
from jaxkin.joints.pairs import revolute as revolute
from jaxkin.joints.pairs import screw as screw
from jaxkin.joints.pairs import spherical as spherical
from jaxkin.joints.pairs import universal as universal
from jaxkin.linkage.closure_equations import ClosureEquations as ClosureEquations
from jaxkin.linkage.linkage import Linkage as Linkage
from jaxkin.mechanism.lost_contacts import LostContact as LostContact
from jaxkin.mechanism.mechanism import Mechanism as Mechanism
from jaxkin.mechanism.motion import Motion as Motion
from jaxkin.mechanism.plan import Plan as Plan
from jaxkin.mechanism.pose import Pose as Pose
from jaxkin.mechanism.pose_error import PoseError as PoseError
from jaxkin.mechanism.reassembly import Move as Move
from jaxkin.mechanism.reassembly import Reassembly as Reassembly
from jaxkin.mechanism.stream import Stream as Stream
from jaxkin.mechanism.targets import Target as Target
from jaxkin.mechanism.targets import orientation as orientation
from jaxkin.mechanism.targets import point as point
from jaxkin.mechanism.targets import pose as pose
from jaxkin.mobility.idle import IdleMotion as IdleMotion
from jaxkin.mobility.mobility import Mobility as Mobility
from jaxkin.mobility.open_loops import Opening as Opening
from jaxkin.solve.options import METHODS as METHODS
from jaxkin.solve.options import SolverOptions as SolverOptions
from jaxkin.solve.status import Status as Status
from jaxkin.topology.elements import StructureElement as StructureElement
from jaxkin.topology.loops import Loop as Loop
from jaxkin.topology.structure import LoopGroup as LoopGroup
from jaxkin.topology.structure import Structure as Structure
from jaxkin.topology.structure import structure as structure
from jaxkin.view.gallery import draw_gallery as draw_gallery
from jaxkin.view.inspection import draw_inspection as draw_inspection
from jaxkin.view.storyboard import storyboard as storyboard

__version__ = "0.1.0"
