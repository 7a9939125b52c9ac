"""Resolvers side by side: on random stacks, on the cells, and through transitions."""
