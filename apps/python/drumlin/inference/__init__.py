"""The grains behind a measurement: posterior of friction and its like from numbers of scenes (docs/formats/infer.md)."""
