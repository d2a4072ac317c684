"""A program in two tiers: the same numbers from both, and the second one exactly where its operations say."""

import jax.numpy as jnp
import numpy as np
import pytest

from jaxkin.solve.execution import two_tiers


@pytest.fixture
def compiled(monkeypatch):
    """Whether each compilation was a quick one, in order."""
    seen, compile_it = [], two_tiers._compiled

    def noted(lowered, quick):
        seen.append(quick)
        return compile_it(lowered, quick)

    monkeypatch.setattr(two_tiers, "_compiled", noted)
    return seen


def test_compiled_anew_once_after_so_many_operations(monkeypatch, compiled):
    monkeypatch.setattr(two_tiers, "QUICK_OPERATIONS", 3.5 * 200)

    def doubled(x):
        return 2.0 * x

    call = two_tiers.TwoTiers(doubled).search()
    tiers = []
    for number in range(8):
        x = np.arange(200.0) + number
        assert np.array_equal(call(x), 2.0 * x)
        tiers.append(len(compiled))
    # 200 products a call: the fourth call would pass 3.5 of them
    assert tiers == [1, 1, 1, 2, 2, 2, 2, 2]
    assert compiled == [True, False]


def test_one_compilation_where_little_is_computed(compiled):
    call = two_tiers.TwoTiers(lambda x: jnp.sum(jnp.sin(x))).search()
    x = np.linspace(0.0, 1.0, 50)
    for _ in range(20):
        # a sum of fifty numbers, in whatever order
        assert float(call(x)) == pytest.approx(np.sum(np.sin(x)), rel=50 * np.finfo(float).eps)
    assert compiled == [True]
