"""Poses of one sweep over several devices, of one process and of two: each follows the motion to its own poses.

Run in processes of their own: the number of devices is fixed when JAX starts.
"""

import os
import socket
import subprocess
import sys
from pathlib import Path

import pytest

pytestmark = pytest.mark.long
TESTS = Path(__file__).parents[1]

SHARDED = """
import jax
import numpy as np

jax.config.update("jax_enable_x64", True)
DISTRIBUTED
from jax.sharding import NamedSharding, PartitionSpec
from reference.mechanisms import planar_fourbar

mechanism = planar_fourbar()
devices = jax.devices()
assert len(devices) == 4, devices
mesh = jax.make_mesh((4,), ("poses",))
own = PartitionSpec("poses")
angles = np.linspace(-3.0, 9.0, 400)


def solved(inputs):
    motion = mechanism.sweep({"A": inputs})
    return motion.displacements, motion.status, motion.residual


sharded = jax.jit(jax.shard_map(solved, mesh=mesh, in_specs=own, out_specs=own, check_vma=False))
inputs = jax.make_array_from_callback(angles.shape, NamedSharding(mesh, own), lambda index: angles[index])
found = sharded(inputs)
program = sharded.lower(inputs).compile().as_text()
for word in ("all-reduce", "all-gather", "all-to-all", "collective-permute"):
    assert word not in program, word

expected = solved(angles)
assert len(jax.tree.leaves(found)) == len(jax.tree.leaves(expected)) == 6
for whole, split in zip(jax.tree.leaves(expected), jax.tree.leaves(found), strict=True):
    for shard in split.addressable_shards:
        # residuals are rounding; poses the same to a few of it, though followed in other steps
        np.testing.assert_allclose(shard.data, np.asarray(whole)[shard.index], atol=1e-12)
print("same", flush=True)
"""


def start(script: str, devices: int) -> subprocess.Popen:
    environment = os.environ | {
        "XLA_FLAGS": f"--xla_force_host_platform_device_count={devices}",
        "PYTHONPATH": os.pathsep.join([str(TESTS), *sys.path]),
        "JAX_PLATFORMS": "cpu",
    }
    return subprocess.Popen(
        [sys.executable, "-c", script], env=environment, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True
    )


def finished(process: subprocess.Popen) -> None:
    try:
        output, errors = process.communicate(timeout=300)
    finally:
        process.kill()
    assert output == "same\n", errors[-3000:]


def test_four_devices_of_one_process():
    finished(start(SHARDED.replace("DISTRIBUTED", ""), devices=4))


def test_two_processes():
    with socket.socket() as free:
        free.bind(("127.0.0.1", 0))
        port = free.getsockname()[1]
    joined = 'jax.distributed.initialize("127.0.0.1:{}", num_processes=2, process_id={})'
    processes = [start(SHARDED.replace("DISTRIBUTED", joined.format(port, rank)), devices=2) for rank in (0, 1)]
    for process in processes:
        finished(process)
