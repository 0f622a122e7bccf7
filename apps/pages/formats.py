"""How pages say numbers: as many digits as a reader needs, a dash for what is not known. The JSON files have all digits."""

import json
import math

DASH = "–"


def is_known(value):
    return isinstance(value, (int, float)) and not isinstance(value, bool) and math.isfinite(value)


def value_of(measured):
    """The number of {"value": } or a number itself; NaN where it is not known."""
    value = measured.get("value") if isinstance(measured, dict) else measured
    return value if is_known(value) else math.nan


def number(value, pattern=".4g"):
    return format(value, pattern) if is_known(value) else DASH


def measured(value):
    """A number, with its 99 % interval or the paper's stated half width where there is one."""
    if not isinstance(value, dict):
        return number(value)
    half_width = value.get("ci99", value.get("half_width"))
    return number(value.get("value")) + (f" ± {half_width:.2g}" if is_known(half_width) else "")


def percent(share, digits=0):
    return f"{100 * share:.{digits}f} %" if is_known(share) else DASH


def difference(to, origin):
    """Of `to` from `origin`, and relative to `origin` where that is not zero."""
    origin, to = value_of(origin), value_of(to)
    if math.isnan(origin) or math.isnan(to):
        return DASH
    change = to - origin
    return f"{change:+.3g}" if origin == 0 else f"{change:+.3g} ({100 * change / abs(origin):+.1f} %)"


def covers(measurement, value):
    """Whether the 99 % interval of a measurement holds the value."""
    interval = measurement.get("ci99") if isinstance(measurement, dict) else None
    return is_known(interval) and abs(value_of(measurement) - value) <= interval


def bound(target):
    """What a target is judged by: its limit, or the noise floor of the particles."""
    return target["noise_floor"] if target.get("judged_by") == "noise floor" else target["limit"]


def over_limit(target):
    """How many times what it is judged by a target's error is; NaN when it was not measured."""
    return value_of(target["value"]) / bound(target)


def by_noise_alone(target):
    """Whether a target is met because its error lies within the noise floor of the particles, and beyond its limit."""
    return target["outcome"] == "met" and value_of(target["value"]) > target["limit"]


def standing(target):
    """Outcome of a target as the class of its cell: met, near (within the noise floor alone), missed, not_measured."""
    return "near" if by_noise_alone(target) else target["outcome"]


def verdict_words(target):
    return "met within the noise" if by_noise_alone(target) else target["outcome"].replace("_", " ")


def largest_miss(targets):
    """The missed target that is furthest beyond its limit; None where all are met."""
    missed = [target for target in targets if target["outcome"] == "missed"]
    return max(missed, key=lambda target: math.inf if math.isnan(over_limit(target)) else over_limit(target), default=None)


def above_by_noise(targets):
    """The targets that another run of the particles would miss."""
    return [target for target in targets if value_of(target.get("floor")) > target["limit"]]


def known_items(entries):
    return [(name, value) for name, value in entries.items() if is_known(value)]


def coefficients(law):
    """"c0 = 0.31 ± 0.02, c1 = 0.0012" of a law."""
    return ", ".join(f"{name} = {measured(value)}" for name, value in law.items()) or DASH


def as_json(value, indent=2):
    return json.dumps(value, indent=indent, ensure_ascii=False)


FILTERS = {function.__name__: function for function in (
    is_known, value_of, number, measured, percent, difference, covers, bound, over_limit, standing, verdict_words, largest_miss, above_by_noise, known_items,
    coefficients, as_json)}
