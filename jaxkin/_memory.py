"""What is found once for an object and kept as long as the object lives."""

from __future__ import annotations

from collections.abc import Callable
from functools import wraps
from typing import TypeVar
from weakref import WeakKeyDictionary

Given = TypeVar("Given")
Found = TypeVar("Found")


def once_for_each(function: Callable[[Given], Found]) -> Callable[[Given], Found]:
    """Remember what a function finds for each object, by its identity; what is found must not refer to the object."""
    kept: WeakKeyDictionary[Given, Found] = WeakKeyDictionary()

    @wraps(function)
    def found(given: Given) -> Found:
        if given not in kept:
            kept[given] = function(given)
        return kept[given]

    return found
