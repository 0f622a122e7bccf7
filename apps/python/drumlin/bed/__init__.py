"""What `drumlin calibrate --memory`, `--amount` and `--nonlocal` fit to the maps of a drum's bed: the memory of the stress's axes, what the past adds to
its amount, and the length over which flow spreads (docs/formats/rheology.md). The material's paths and what they carry are those of `_drumlin`."""
