"""Robots and their tools: one package a robot, with its model file."""
