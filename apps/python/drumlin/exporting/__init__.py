"""Runs for other programs (docs/formats/export.md): `drumlin export --to FORMAT` starts command.py. A format is a file with a class that takes instants, and
its row in command.py."""
