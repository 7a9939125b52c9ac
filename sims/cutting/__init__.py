"""Meat cutting: one arm cuts along a guide line, one pulls the muscles apart."""
