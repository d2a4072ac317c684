"""Kinds of assemblies that designers draw, each with the joints that it is meant to have: those imported here."""

from drawings import devices as devices
from drawings import drives as drives
from drawings import fittings as fittings
from drawings import vehicles as vehicles
from drawings import workshop as workshop
