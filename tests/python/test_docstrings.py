"""Every public name says what it is; arrays and numbers of a simulation with shape and unit."""

import inspect

import drumlin
import pytest

NAMES = {name: getattr(drumlin, name) for name in drumlin.__all__}
NAMES |= {f"{home}.{name}": value for home in ("plot", "study") for name, value in vars(getattr(drumlin, home)).items()
          if not name.startswith("_") and getattr(value, "__module__", "").startswith("drumlin." + home)}
NAMES |= {f"{name}.{member}": value for name, cls in NAMES.items() if inspect.isclass(cls) for member, value in vars(cls).items()
          if not member.startswith("_") and (callable(value) or isinstance(value, (property, classmethod)))}


@pytest.mark.parametrize("name", NAMES)
def test_every_public_name_says_what_it_is(name):
    assert (inspect.getdoc(NAMES[name]) or "").strip()


def test_arrays_tell_shape_and_unit():
    for name in ("x", "z", "v_x", "v_z", "spin", "radius", "mass"):
        assert "(grains,)" in NAMES["Simulation." + name].__doc__ and any(unit in NAMES["Simulation." + name].__doc__ for unit in (" d.", "sqrt(g", "rho0"))


@pytest.mark.parametrize("name", [name for name in drumlin.__all__ if callable(getattr(drumlin, name)) and name != "version"
                                  and not (inspect.isclass(getattr(drumlin, name)) and issubclass(getattr(drumlin, name), Exception))])
def test_every_public_function_and_class_has_an_example(name):
    assert ">>> " in inspect.getdoc(getattr(drumlin, name))
