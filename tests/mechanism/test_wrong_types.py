"""What is no drive, joint, point or loss at all is refused in words: what arrived, and what to write.

In a process of its own, since here the types in signatures are executed, which refuses it in words of another kind.
"""

import json
import subprocess
import sys

import pytest

BEGIN = """
import json, sys
import numpy as np
import jax
import jaxkin as jk
from jaxkin.effects.rates import velocities

jax.config.update("jax_enable_x64", True)
hinge = jk.revolute("A", "ground", "arm", point=(0, 0, 0), axis=(0, 0, 1))
arm = jk.Mechanism.build(fixed=["ground"], joints=[hinge])
angles = np.linspace(0, 1, 3)
motion = arm.sweep({"A": angles})
said = {}
for line in json.loads(sys.argv[1]):
    try:
        eval(line)
    except ValueError as error:
        said[line] = str(error)
print(json.dumps(said))
"""

REFUSED = {
    "jk.gear('A', 'B', '2')": "the ratio of 'A' must be one finite number, got '2'",
    "jk.relation([('A', 1.0)])": "the factors of a relation are given by name, as in {'A.phi': 2.0, 'B.phi': -1.0}",
    "jk.Mechanism.build(fixed=['ground'], joints=[hinge], couplings=['gear'])": "couplings are made by jk.gear",
    "jk.Mechanism.build(fixed=['ground'], joints=[hinge], unit='inch')": "unit must be one of um, mm, cm, dm, m, km, "
    "in, ft, or '' for metres, got 'inch'",
    "arm.sweep(angles)": "driven displacements are given by name, as in {'A': angles}, got array(",
    "arm.sweep(None)": "as in {'A': angles}, got None",
    "arm.stream(angles)": "as in {'A': angles}, got array(",
    "arm.sweep({0: angles})": "a drive names 'joint' or 'joint.coordinate', as in {'A': angles}, got 0",
    "arm.sweep({'A': angles + 1j})": "drive 'A': the displacements must be real numbers, got array(",
    "arm.sweep({'A': ['0.1']})": "drive 'A': the displacements must be real numbers, got ['0.1']",
    "arm.sweep({'A': [None, 0.1]})": "drive 'A': the displacements must be real numbers, got [None, 0.1]",
    "arm.sweep({'A': np.array([1], 'timedelta64[s]')})": "drive 'A': the displacements must be real numbers, got array",
    "jax.jit(lambda a: arm.sweep({'A': a + 0j}).status)(angles)": "must be real numbers, got complex numbers that JAX",
    "arm.sweep({jk.point('arm', (1, 0, 0)): np.zeros((1, 3)) + 1j})": "the values must be real numbers, an array",
    "jk.inverse(arm, {jk.point('arm', (1, 0, 0)): np.zeros((1, 3)) + 1j})": "the values must be real numbers, an arra",
    "jk.inverse(arm, {'A': angles + 1j})": "target 'A': the displacements must be real numbers, got array(",
    "jk.project(arm, {'A': angles + 1j})": "the coordinates of 'A' must be real numbers, an array (poses, 1), got",
    "jk.project(arm, {'A': ['0.1']})": "the coordinates of 'A' must be real numbers, an array (poses, 1), got ['0.1']",
    "arm.closure({'A': 1j})": "has 1 coordinates (phi): give one number for each, got 1j",
    "arm.sweep({'A': angles}, tolerance='small')": "must be a positive finite number such as 1e-9, got 'small'",
    "arm.sweep({'A': angles}, options={'tolerance': 1e-9})": "options must be a jk.SolverOptions, such as "
    "jk.SolverOptions(tolerance=1e-9), got {'tolerance': 1e-09}",
    "jk.SolverOptions(cores=1.5)": "cores must be a whole number, 1 or more, such as jk.SolverOptions(cores=2), got 1",
    "jk.SolverOptions(rescue_steps=None)": "such as jk.SolverOptions(rescue_steps=200), got None",
    "jax.jit(lambda t: (jk.SolverOptions(tolerance=t), t)[1])(1e-3)": "SolverOptions are static, and this tolerance is "
    "traced by JAX: write sweep(drive, tolerance=...) instead",
    "arm.sweep({'A': angles}, tolerance=[1e-9])": "must be a positive finite number such as 1e-9, got [1e-09]",
    "jk.project(arm, {'A': angles}, options={'tolerance': 1e-9})": "options must be a jk.SolverOptions, such as",
    "jax.jit(lambda a: jk.clashes(arm.sweep({'A': a})).distance)(angles)": "clashes are found on the host: call jk.",
    "jax.jit(lambda a: jk.contact_validity(arm.sweep({'A': a})).first)(angles)": "call jk.contact_validity outside of",
    "jax.jit(lambda a: jk.curve_contacts(arm.sweep({'A': a})).curvature)(angles)": "call jk.curve_contacts outside of",
    "jax.jit(lambda a: jk.swept_volume(arm.sweep({'A': a}), 'arm').volume)(angles)": "call jk.swept_volume outside of",
    "jax.jit(lambda r: jk.workspace(arm, {'A': r}, 'arm', (1, 0, 0)).points)(angles)": "call jk.workspace outside of",
    "arm.sweep({'A': angles}, method='newton')": "there is no method 'newton' among continuation, gauss-newton,",
    "arm.stream({'A': angles}, chunk=True)": "chunk must be a whole number, 1 or more, got True",
    "arm.sweep({'A': angles}, throw='no')": "throw must be True or False, got 'no'",
    "arm.stream({'A': angles}, chunk=1.5)": "chunk must be a whole number, 1 or more, got 1.5",
    "arm.with_lengths(3.0)": "lengths are given by name, as in {('coupler', 'B', 'C'): 3.6}, got 3.0",
    "arm.with_points({'A': 'abc'})": "the point of 'A' must be three finite numbers (x, y, z), got 'abc'",
    "arm.with_frames({'A': 'abc'})": "the frame of 'A' must be a 4x4 pose of finite numbers, got 'abc'",
    "arm.with_points(3)": "points are given by name, as in {'A': (x, y, z)}, got 3",
    "arm.with_frames(None)": "frames are given by name, as in {'A': pose}, got None",
    "arm.joints_between('ground', 'amr')": "there is no part 'amr'; did you mean 'arm'?",
    "motion.points('arm', None)": "a point must be three finite numbers (x, y, z), got None",
    "motion.points('arm', 'tip')": "a point must be three finite numbers (x, y, z), got 'tip'",
    "motion.points('arm', (1.0, 2.0, np.nan))": "a point must be three finite numbers (x, y, z), got (1.0, 2.0, nan)",
    "velocities(motion, {'A': 1.0}).points('arm', (0, np.inf, 0))": "three finite numbers (x, y, z), got (0, inf, 0)",
    "velocities(motion, {'A': 1.0}).points('arm', (0, 0))": "three finite numbers (x, y, z), got shape (2,)",
    "velocities(motion, 1.0)": "as in {'A.phi': 1.0}, got 1.0",
    "velocities(arm, {'A': 1.0})": "rates are those of a motion, mechanism.sweep(drive), got Mechanism",
    "jk.Mechanism.build(fixed=['ground'], joints=hinge)": "be a list of joints, such as [jk.revolute(...)], got the",
    "jk.Mechanism.build(fixed=['ground'], joints=[hinge, 'B'])": "got 'B' among them",
    "jk.Mechanism.build(fixed=['ground'], joints=3)": "got 3",
    "jk.Mechanism.build(fixed=['ground'], joints=[hinge], align='fine')": "align must be a number from 0",
    "jk.Mechanism.build(fixed=['ground'], joints=[hinge], align=True)": "align must be a number from 0",
    "jk.revolute('A', 'ground', 'arm', point=(0, 0, 0), axis='z')": "must be three finite numbers (x, y, z), got 'z'",
    "jk.screw('A', 'p', 'q', point=(0, 0, 0), axis=(0, 0, 1), pitch='3')": "pitch must be a finite number, the advance",
    "jk.screw('A', 'p', 'q', point=(0, 0, 0), axis=(0, 0, 1), pitch=np.nan)": "pitch must be a finite number, the",
    "jk.SolverOptions(tolerance='1e-9')": "must be a positive finite number such as 1e-9, got '1e-9'",
    "jk.SolverOptions(tolerance=True)": "must be a positive finite number such as 1e-9, got True",
    "jk.joint_on_frames('A', 'p', 'q', kind='screw', frame1=np.eye(4), frame2=np.eye(4), pitch='2')": "joint 'A': "
    "pitch must be a finite number, the advance per turn, got '2'",
    "jk.inverse(arm, {'A': angles}, rest={'A': 'x'})": "the place of rest of 'A' must be one finite number, got 'x'",
    "jk.surface_points(lambda u, v: (u, v, u), (0, 1), (0, 1), samples=40)": "samples must be a list of two whole "
    "numbers, such as (40, 40), got 40",
    "jk.optimize(None, arm, drive={'A': angles})": "an objective of jk.design, or a function of the motion, got None",
    "jk.load({'crank': 5})": "part 'crank': expected the path of a file, as in {'crank': 'crank.stl'}; got 5",
    "jk.load('.')": ". is a folder: give the path of a STEP file in it",
}


@pytest.mark.long
def test_what_is_of_no_use_is_refused_in_words():
    done = subprocess.run(
        [sys.executable, "-c", BEGIN, json.dumps(list(REFUSED))], capture_output=True, text=True, check=False
    )
    assert done.returncode == 0, done.stderr
    said = json.loads(done.stdout)
    missing = {line: said.get(line) for line, words in REFUSED.items() if words not in said.get(line, "")}
    assert not missing
