"""Snapshots of other programs (docs/formats/import.md): `drumlin import` starts command.py once it has read the description. A format is a file with a
class of frames, its row in frames.py and its table of keys in particles/import."""
