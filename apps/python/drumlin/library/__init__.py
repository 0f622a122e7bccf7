"""Laws of given grains from the library of laws (docs/formats/laws.md)."""
