"""Units and axes that a description gives to files which have none."""

import dataclasses


@dataclasses.dataclass
class Units:
    """What one unit of a file is in SI."""

    length_unit_m: float = 1.0
    time_unit_s: float = 1.0
    mass_unit_kg: float = 1.0

    def of(self, quantity):
        """Of a quantity of frame.py but a force."""
        return {"number": 1.0, "time": self.time_unit_s, "length": self.length_unit_m, "velocity": self.length_unit_m / self.time_unit_s,
                "rate": 1 / self.time_unit_s}[quantity]


def units_of(source):
    """Those of the description, SI where it has none."""
    return Units(**{field.name: source[field.name] for field in dataclasses.fields(Units) if source.get(field.name) is not None})


def axes_of_files(source):
    """The axes of the files that matter: of discs x and the one that points up."""
    return "xyz" if source["dimensions"] == 3 else source["plane"]


def force_unit(source, units):
    """In SI, of discs per metre of depth. Negative where the file tells the force on the second grain."""
    sign = 1 if source["force_on"] == "first" else -1
    return sign * units.mass_unit_kg * units.length_unit_m / (units.time_unit_s * units.time_unit_s) / source.get("depth_m", 1.0)
