"""What the README's speed table comes from: `python -m benchmarks`.

Kept free of imports: the peers' workers run this package in environments of their own.
"""
