"""Writes a list of grains for `grains.listed`: a gas with velocities, or a loose bed with a heavy disc above it.

usage: list_grains.py gas --count N --box X Z --diameter D --speed V [--seed S]
       list_grains.py intruder --count N --width X --diameters D_MIN D_MAX --intruder D --above H --velocity V [--seed S]
Lengths in mm, speeds in mm/s; the list goes to standard output. speed: standard deviation of either component of the velocity.
"""

import argparse

import numpy


def placed_at_random(random, count, box, diameter, margin):
    """Centres in a box that is periodic in x, none closer than margin diameters to another."""
    places = []
    while len(places) < count:
        place = random.uniform([0, 0.5 * diameter], [box[0], box[1] - 0.5 * diameter])
        other = numpy.array(places).reshape(-1, 2) - place
        other[:, 0] -= box[0] * numpy.round(other[:, 0] / box[0])
        if not len(other) or numpy.hypot(*other.T).min() > margin * diameter:
            places.append(place)
    return numpy.array(places)


def gas(options):
    random = numpy.random.default_rng(options.seed)
    places = placed_at_random(random, options.count, options.box, options.diameter, 1.02)
    velocities = random.normal(size=(options.count, 2))
    velocities -= velocities.mean(axis=0)
    velocities *= options.speed / numpy.sqrt((velocities ** 2).mean(axis=0))
    for (x, z), (v_x, v_z) in zip(places, velocities):
        yield x, z, options.diameter, v_x, v_z


def intruder(options):
    random = numpy.random.default_rng(options.seed)
    largest = options.diameters[1]
    per_row = int((options.width - 0.1 * largest) / (1.02 * largest))
    for k in range(options.count):
        row, column = divmod(k, per_row)
        x = (column + 0.5) * options.width / per_row
        yield x, (row + 0.6) * 1.02 * largest, random.uniform(*options.diameters), 0, 0
    top = (-(-options.count // per_row) + 0.1) * 1.02 * largest
    yield 0.5 * options.width, top + options.above + 0.5 * options.intruder, options.intruder, 0, options.velocity


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    kinds = parser.add_subparsers(required=True)
    one = kinds.add_parser("gas")
    one.set_defaults(rows=gas)
    one.add_argument("--box", type=float, nargs=2, required=True)
    one.add_argument("--diameter", type=float, required=True)
    one.add_argument("--speed", type=float, required=True)
    two = kinds.add_parser("intruder")
    two.set_defaults(rows=intruder)
    two.add_argument("--width", type=float, required=True)
    two.add_argument("--diameters", type=float, nargs=2, required=True)
    two.add_argument("--intruder", type=float, required=True)
    two.add_argument("--above", type=float, required=True)
    two.add_argument("--velocity", type=float, required=True)
    for each in (one, two):
        each.add_argument("--count", type=int, required=True)
        each.add_argument("--seed", type=int, default=1)
    options = parser.parse_args()
    print("x_mm,z_mm,diameter_mm,v_x_mm_s,v_z_mm_s")
    for row in options.rows(options):
        print(",".join(f"{value:.6g}" for value in row))


if __name__ == "__main__":
    main()
