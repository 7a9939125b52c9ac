"""Deformable meat: two muscles, the aponeurosis between them, and a knife in it."""

from sims.cutting.meat.meat import Meat, Toughness
from sims.cutting.meat.tissue import Tissue

__all__ = ["Meat", "Tissue", "Toughness"]
