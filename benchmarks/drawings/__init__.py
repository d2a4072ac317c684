"""Kinds of assemblies that designers draw, each with the joints that it is meant to have: those imported here."""

from drawings import articulated as articulated
from drawings import balanced as balanced
from drawings import bodywork as bodywork
from drawings import desktop as desktop
from drawings import devices as devices
from drawings import driveline as driveline
from drawings import drives as drives
from drawings import everyday as everyday
from drawings import fittings as fittings
from drawings import fixtures as fixtures
from drawings import folding as folding
from drawings import guided as guided
from drawings import handheld as handheld
from drawings import household as household
from drawings import linkages as linkages
from drawings import machines as machines
from drawings import mounted as mounted
from drawings import powered as powered
from drawings import reciprocating as reciprocating
from drawings import road as road
from drawings import robotics as robotics
from drawings import turning as turning
from drawings import vehicles as vehicles
from drawings import workshop as workshop
