"""Long-lived processes, one an environment, that run ticks when asked to."""
