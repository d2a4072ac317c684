"""What to write in place of names that are not there: those that other programs have for the same thing."""

from __future__ import annotations

import inspect
import sys
from collections.abc import Callable
from typing import TYPE_CHECKING, Self

from jaxkin._names import closest, listed

_PICTURES = "plot draw show render view picture figure image visualize visualise display"
_TABLES = "to_csv csv write_csv save_csv to_dataframe dataframe to_pandas to_numpy to_dict table write export dump"
_WORDS = {
    'jk.storyboard(motion, "motion.png") draws a motion, motion.save("out") animates it (motion.html), '
    'mechanism.structure.plot("loops.png") draws loops, and results have their own plot("picture.png")': _PICTURES,
    'motion.save("out") writes the animation motion.html, and motion.glb': (
        "animate animation html video gif movie play to_html save_html save_animation"
    ),
    'motion.save("out") writes tables, motion.csv and motion.npz, an animation and a picture': _TABLES,
    'jk.load("machine.step") reads STEP files, meshes and robots, jk.load_study("machine.toml") studies': (
        "read open read_step load_step from_step import_step load_urdf read_urdf from_urdf load_mjcf load_xml "
        "load_robot load_stl load_mesh load_file from_file loads"
    ),
    'jk.Mechanism.build(fixed=["ground"], joints=[...]) makes a mechanism, and jk.load("mechanism.json") reads the one '
    "that mechanism.save wrote": (
        "link bar add add_joint add_link add_body body fourbar four_bar linkage_of from_dict from_json load_mechanism"
    ),
    'jk.revolute("A", "ground", "crank", point=(0, 0, 0), axis=(0, 0, 1)) is a hinge; others are jk.prismatic, '
    "jk.cylindrical, jk.spherical, jk.planar, jk.universal, jk.screw and jk.fixed": (
        "pin hinge rotary pivot revolute_joint slider slide linear prismatic_joint ball ball_joint hooke cardan "
        "weld rigid_joint pin_joint"
    ),
    "mechanism.mobility() counts the freedoms": "dof dofs degrees_of_freedom freedoms ndof nq nv gruebler",
    "mechanism.structure.loops has the loops, and mechanism.structure.plot() draws them": "loops cycles graph topology",
    "mechanism.parts names the parts, and mechanism.bodies what moves as one": "links link_names part_names body_names",
    "mechanism.joints has the joints by name, and joint.full_names their coordinates": (
        "joint joint_names coordinate_names variables dof_names"
    ),
    "mechanism.lengths has the lengths, and mechanism.with_lengths changes them": (
        "dimensions link_lengths length parameters params set_length set_lengths"
    ),
    'mechanism.sweep({"joint": values}) moves it through a range, and mechanism.solve({"joint": value}) to one pose': (
        "forward forward_kinematics fk simulate simulation run move moved drive driver actuate set_joint step "
        "evaluate kinematics position_analysis"
    ),
    'jk.inverse(mechanism, {jk.point("part", (x, y, z)): places}) reaches places, and mechanism.sweep takes such '
    "targets, too": "ik inverse_kinematics solve_ik reach",
    "derivatives are those of JAX: jax.jacobian of a function of mechanism.sweep or mechanism.solve; "
    "mechanism.closure has the Jacobian of the loops": "jacobian jacobians gradient derivative derivatives sensitivity",
    'jk.velocities(motion, {"joint": rate}) and jk.accelerations(motion, {"joint": rate}) compute rates': (
        "velocity speed speeds rates acceleration angular_velocity velocity_analysis"
    ),
    'jk.drive_forces(motion, jk.masses(mechanism, "steel")) computes drive forces and torques, jk.reactions those in '
    "joints; gravity= is their argument": (
        "torques forces drive_torque drive_force holding_torque gravity dynamics inverse_dynamics"
    ),
    'jk.masses(mechanism, "steel") computes masses from solids': "mass weight inertia inertias density center_of_mass",
    'motion.points("part", (x, y, z)) is the path of a point of a part': (
        "position positions trace path paths trajectory coupler curve point_path xyz x y z"
    ),
    'motion.transforms["part"] is the displacement of a part, (poses, 4, 4)': (
        "transform rotation rotations orientations frames matrices placement placements body_poses"
    ),
    'motion.coordinates["joint"] has the displacements of a joint, motion.inputs those of the drive': (
        "angle angles q qpos joint_angles joint_positions displacement values state states time t results keys"
    ),
    'motion.coordinates has the displacements of joints, jk.design.stroke(motion, "joint") is the stroke of one': (
        "stroke strokes travel"
    ),
    "jk.clashes(motion) finds parts that cut each other, jk.design.clearance(motion, jk.design.bar(...), "
    "jk.design.bar(...)) is differentiable": "collision collisions interference clash clearance collide min_distance",
    'motion.sigma_min is 0 where a pose is singular, jk.limits(mechanism, "joint") finds dead points, jk.singularities '
    "the curves of two inputs": "singularity singular dead_points dead_point toggle condition manipulability",
    "jk.optimize(jk.design.path(...), mechanism, drive=..., lengths=...) finds a design": (
        "synthesis synthesize synthesise optimise minimize minimise fit design_lengths optimization"
    ),
    'jk.write_urdf(mechanism, "robot.urdf"), jk.write_mjcf(mechanism, "model.xml") and '
    'jk.write_asmt(mechanism, "model.asmt") write robots': "to_urdf save_urdf to_mjcf",
    'from jaxkin.examples import path; jk.load(path("fourbar")) reads an assembly that comes with the package': (
        "example examples demo path_of_example"
    ),
}
"""What to write, and the names that it answers."""

_ADVICE = {name: advice for advice, names in _WORDS.items() for name in names.split()}

MAX_LETTERS = 60
"""Letters of the names that the line of a result lists: it fits on one line of a terminal."""

_HELD = ("Mechanism", "Motion", "Assembly")
"""What users hold: whose names may have been asked of another."""

_MADE_BY = {
    "Mechanism": 'jk.Mechanism.build(fixed=["ground"], joints=[...]) makes a mechanism of joints by hand',
    "Assembly": 'jk.load("machine.step") reads an assembly',
}
"""What makes what users hold, for those who call its class with what that does not take."""


class Guided:
    """What users hold: one line in place of all its numbers, and asked for a name that it has not, it says what to
    write instead."""

    def __new__(cls, *given: object, **named: object) -> Self:
        unknown = [name for name in named if name not in getattr(cls, "__dataclass_fields__", {})]
        if cls.__name__ in _MADE_BY and (unknown or isinstance(next(iter(given), None), list | str)):
            what = listed([repr(name) for name in unknown]) if unknown else type(given[0]).__name__
            raise TypeError(f"the class {cls.__name__} itself takes no {what}: {_MADE_BY[cls.__name__]}")
        return super().__new__(cls)

    def __repr__(self) -> str:
        return f"<{type(self).__name__} of {listed(tuple(getattr(self, 'parts', ())))}>"

    @classmethod
    def _instead_of(cls, name: str) -> str:
        """Write the end of a message about a name that is not there."""
        return _instead(name, _names_of(cls))

    if not TYPE_CHECKING:  # else a checker of types takes every name for one that is there

        def __getattr__(self, name: str) -> object:
            owner = type(self)
            if hasattr(owner, name):  # a property that failed with an AttributeError of its own: raise that
                return object.__getattribute__(self, name)
            raise _missing(f"{owner.__name__!r} object", name, owner._instead_of)


class Result(Guided):
    """What a function finds out: one line in place of all its numbers, with the names of these, which are also told to
    whoever asks it for another one."""

    def __init_subclass__(cls) -> None:
        super().__init_subclass__()
        from jaxkin._traced import tell_known_numbers  # imports JAX, which `import jaxkin` does not

        tell_known_numbers(cls)

    def __repr__(self) -> str:
        owner = type(self)
        ending = "" if owner.__str__ is object.__str__ else "; print() sums it up"
        names = [name for name in _listed_names(owner) if not inspect.isfunction(getattr(owner, name, None))]
        said = ", ".join(names)
        if len(said) > MAX_LETTERS:
            said = f"{said[:MAX_LETTERS].rpartition(', ')[0]}, ..."
        return f"<{owner.__name__} with {said}{ending}>"

    @classmethod
    def _instead_of(cls, name: str) -> str:
        known = _listed_names(cls)
        if found := closest(name, known):
            return found
        for call, words in (('plot("picture.png")', _PICTURES), ('save("table.csv")', _TABLES)):
            if name in words.split() and call.partition("(")[0] in known:
                return f": write {call}"
        if "motion" in known and name in _names_of(sys.modules["jaxkin"].Motion):
            return f"; did you mean .motion.{name}?"
        return f"; it has {', '.join(known)}"


def missing(owner: str, name: str, known: list[str]) -> AttributeError:
    """Make the error for a name that an owner has not, with what to write instead where that is known."""
    return _missing(owner, name, lambda name: _instead(name, known))


def called(package: str) -> TypeError:
    """Make the error for a package within jaxkin that is called as if it were a function: "jaxkin.mobility"."""
    name = package.rpartition(".")[2]
    holders = [held for held in _HELD if inspect.isfunction(getattr(getattr(sys.modules["jaxkin"], held), name, None))]
    instead = f"; did you mean {holders[0].lower()}.{name}(...)?" if holders else _instead(name, [])
    return TypeError(f"{package} is a package of modules, and no function{instead}")


def no_function(owner: object, written: str) -> TypeError:
    """Make the error for a result that is called as if it were a function; `written` is how it is asked for."""
    names = ", ".join(_listed_names(type(owner)))
    return TypeError(f"{written} is no function: write it without brackets; it has {names}")


def _missing(owner: str, name: str, instead: Callable[[str], str]) -> AttributeError:
    """Make the error for a name that an owner has not; `instead` writes its end, for names that are not private."""
    said = f"{owner} has no attribute {name!r}"
    # with an object, Python would look for a near name in it, too, and say it twice
    return AttributeError(said if name.startswith("_") else said + instead(name), name=name, obj=None)


def _instead(name: str, known: list[str]) -> str:
    """Write the end of a message: what stands for a name elsewhere, else the nearest known name, or nothing."""
    if advice := _ADVICE.get(name):
        return f": {advice}"
    package = sys.modules["jaxkin"]
    for held in _HELD:
        if name in _names_of(owner := getattr(package, held)):
            call = "(...)" if inspect.isfunction(getattr(owner, name, None)) else ""
            return f"; did you mean {held.lower()}.{name}{call}?"
    if name in dir(package) and inspect.isfunction(found := getattr(package, name)):
        first = next(iter(inspect.signature(found).parameters), "")
        return f"; did you mean jk.{name}({first}, ...)?"
    return closest(name, known)


def _listed_names(owner: type) -> list[str]:
    """List the public names of a result in the order of its class: fields first, then what follows from them."""
    own = [name for each in reversed(owner.__mro__) if issubclass(each, Result) for name in vars(each)]
    names = [*getattr(owner, "__dataclass_fields__", ()), *own]
    return [name for name in dict.fromkeys(names) if not name.startswith("_")]


def _names_of(owner: type) -> list[str]:
    """List the public names that instances of a class have."""
    return [name for name in {*dir(owner), *getattr(owner, "__dataclass_fields__", ())} if not name.startswith("_")]
