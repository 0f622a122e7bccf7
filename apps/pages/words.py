"""What the names of the files mean to a reader of a page. Values marked as HTML here hold no text from outside."""

from markupsafe import Markup, escape

import quantity_table

# What a missed target tells about the physics.
MEANING = {
    "theta_deg": "The whole surface has another slope: the friction is off as a whole.",
    "Q": "Fill and rotation fix the flow rate: a difference is an error of the computation, not physics.",
    "H": "The flowing layer is thicker or thinner than that of the grains.",
    "lambda": "The creep below the flowing layer decays over another depth than among the grains.",
    "v_x": "The flowing layer moves at another speed.",
    "log10_shear_rate": "The slow creep below the flowing layer has another shear rate.",
    "sigma_zz": "The weight is carried differently, which should not happen when the density is right.",
    "sigma_xz": "The shear stress differs; where hardly anything moves, the law does not determine it.",
    "sigma_xx": "The normal stress along the surface differs: the law has no ratio of normal stresses, or too small a one.",
    "axis_angle_deg": "Among the grains the axes of stress and strain rate differ; a law with one friction coefficient makes them equal.",
}


def name(key):
    """The key itself where nothing better is known."""
    known = quantity_table.SCALARS.get(key) or quantity_table.field(key)
    return key if known.label == key else Markup(known.in_html())


def target(one):
    """"σ_xz, static" of a target."""
    zone = one.get("zone")
    return name(one["quantity"]) if zone is None else escape(name(one["quantity"])) + ", " + zone


def side(content, which):
    """What a side is called: "particles", or with the name of its folder where both sides are of one kind."""
    kinds = {key: content[key].get("kind", key) for key in ("particles", "continuum")}
    if kinds["particles"] != kinds["continuum"]:
        return kinds[which]
    return f"{kinds[which]} {content[which].get('name', which)}"


def the_side(content, which):
    text = side(content, which)
    return text if " " in text else f"the {text}"


def has_relative_error(field):
    """Decades and degrees have an arbitrary zero: an error relative to them says nothing."""
    return not field.startswith("log10_") and quantity_table.field(field).compared != "half turns"
