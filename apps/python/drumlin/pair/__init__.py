"""Particles and continuum of one scene beside each other, over time (docs/formats/pair.md)."""
