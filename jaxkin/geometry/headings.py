"""Heads of the columns of tables, and labels of axes: names with units."""

from __future__ import annotations

from jaxkin.geometry.movements import is_length


def coordinate_with_unit(full_name: str, unit: str) -> str:
    """Head the column of a coordinate "joint.coordinate" by its name and its unit; `unit` is that of lengths, "" where
    it is not known."""
    return with_unit(full_name, unit if is_length(full_name.rpartition(".")[2]) else "rad")


def coordinate_label(full_name: str, unit: str) -> str:
    """Label an axis of a chart by a coordinate "joint.coordinate" and its unit; `unit` is that of lengths, or ""."""
    unit = unit if is_length(full_name.rpartition(".")[2]) else "rad"
    return f"{full_name} ({unit})" if unit else full_name


def places_with_unit(unit: str) -> list[str]:
    """Head the columns of world coordinates; `unit` is that of lengths, "" where it is not known."""
    return [with_unit(axis, unit) for axis in "xyz"]


def with_unit(name: str, unit: str) -> str:
    """Head a column by the name of what it holds and its unit, where that is known."""
    return f"{name} [{unit}]" if unit else name
