"""What the names of the files mean to a reader of a page. Values marked as HTML here hold no text from outside."""

from markupsafe import Markup, escape

NAMES = {name: Markup(text) for name, text in {
    "theta_deg": "slope θ (deg)",
    "Q": "flow rate Q",
    "H": "depth of the flowing layer H (d)",
    "lambda": "decay length λ (d)",
    "lambda_same_window": "λ, read where the particles’ is (d)",
    "shear_rate": "shear rate of the flowing layer",
    "I_th": "inertial number at the interface",
    "nu_bulk": "volume fraction of the bulk",
    "mu_a": "a of μ = a + b ln I",
    "mu_b": "b of μ = a + b ln I",
    "k_flowing": "k in the flowing layer",
    "spin_over_half_vorticity": "spin over half the vorticity",
    "dv_over_shear": "velocity fluctuation over shear rate",
    "domega_over_shear": "spin fluctuation over shear rate",
    "height": "height of the layer (d)",
    "surface_speed": "speed of the surface",
    "bulk_shear_rate": "shear rate of the bulk",
    "bulk_sigma_zz": "σ<sub>zz</sub> of the bulk",
    "bulk_sigma_xz": "σ<sub>xz</sub> of the bulk",
    "bulk_mu": "μ of the bulk",
    "bulk_I": "I of the bulk",
    "bulk_nu": "ν of the bulk",
    "linear_layer_share": "0.4 · shear rate · H² / Q",
    "v_x": "velocity v<sub>x</sub>",
    "v_z": "velocity v<sub>z</sub>",
    "sigma_zz": "σ<sub>zz</sub>",
    "sigma_xz": "σ<sub>xz</sub>",
    "sigma_xx": "σ<sub>xx</sub>",
    "p": "pressure p",
    "mu": "μ",
    "k": "k = σ<sub>xx</sub>/σ<sub>zz</sub>",
    "log10_I": "log<sub>10</sub> I (decades)",
    "log10_shear_rate": "log<sub>10</sub> of the shear rate (decades)",
    "axis_angle_deg": "angle between the axes of stress and strain rate (deg)",
}.items()}

SHORT = NAMES | {name: Markup(text) for name, text in {
    "v_x": "v<sub>x</sub>",
    "v_z": "v<sub>z</sub>",
    "p": "p",
    "k": "k",
    "log10_I": "log<sub>10</sub> I",
    "log10_shear_rate": "log<sub>10</sub> shear rate",
    "axis_angle_deg": "axis angle (deg)",
}.items()}

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
    return NAMES.get(key, key)


def short(key):
    return SHORT.get(key, key)


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
    return not field.startswith("log10_") and field != "axis_angle_deg"
