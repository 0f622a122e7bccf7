"""Which contacts of a problem fold: go back and forth between open, sticking and sliding while the solver stands still.

usage: folding_contacts.py PROBLEM.h5 SOLUTION.h5 PNG
PROBLEM.h5 as `drumlin run` leaves it (with places of contacts), SOLUTION.h5 of `drumlin solve-contacts PROBLEM.h5 --watch SWEEPS --output SOLUTION.h5`.
"""

import sys

import h5py
import numpy as np
from matplotlib.collections import LineCollection

import style

MOST_OF_IT = 0.8  # of the changes: the contacts that make them are drawn
MOST_WIDTH = 2.2  # points, of the line of a contact that carries 4 mean forces
STATES = ("open", "sticking", "sliding")
STATE_COLORS = (style.OTHERS[0], style.PARTICLES, style.CONTINUUM)


class Contacts:
    """Places and normals in d, impulses over their mean, states and changes: an entry per contact."""

    def __init__(self, problem_path, solution_path):
        with h5py.File(problem_path) as problem, h5py.File(solution_path) as solution:
            if "drumlin/contacts" not in problem:
                sys.exit(f"{problem_path}: does not say where its contacts are")
            if "solution/changes" not in solution:
                sys.exit(f"{solution_path}: holds no changes of states (solve-contacts --watch)")
            self.x, self.z, n_x, n_z = (problem["drumlin/contacts/" + name][:] for name in ("x", "z", "normal_x", "normal_z"))
            r = solution["solution/r"][:].reshape(-1, 2)
            self.state, self.changes, self.error = (solution["solution/" + name][:] for name in ("state", "changes", "error"))
        if not len(self.x) == len(r) == len(self.changes):
            sys.exit(f"{solution_path}: is not of {problem_path}")
        self.force = r[:, 0] / max(r[r[:, 0] > 0, 0].mean(), np.finfo(float).tiny) if (r[:, 0] > 0).any() else r[:, 0]
        self.normal = np.column_stack([n_x, n_z])

    def place(self):
        return np.column_stack([self.x, self.z])

    def folding(self):
        """Indices of the fewest contacts that make MOST_OF_IT of all changes, those with the most changes first."""
        order = np.argsort(-self.changes, kind="stable")
        sums = np.cumsum(self.changes[order])
        return order[:int(np.searchsorted(sums, MOST_OF_IT * sums[-1])) + 1] if sums[-1] > 0 else order[:0]


def draw_network(axes, contacts):
    loaded = contacts.force > 0
    reach = 0.5 * contacts.normal[loaded]
    place = contacts.place()[loaded]
    widths = MOST_WIDTH * np.minimum(contacts.force[loaded] / 4, 1)
    axes.add_collection(LineCollection(np.stack([place - reach, place + reach], axis=1), linewidths=widths, colors="0.6"))


def draw_places(axes, contacts, folding):
    draw_network(axes, contacts)
    place = contacts.place()
    for state, (name, color) in enumerate(zip(STATES, STATE_COLORS)):
        own = folding[contacts.state[folding] == state]
        axes.scatter(*place[own].T, s=6 + 30 * contacts.changes[own] / contacts.changes.max(), color=color, linewidths=0, zorder=3,
                     label=f"{len(own)} now {name}")
    low, high = place.min(axis=0), place.max(axis=0)
    axes.set_xlim(low[0] - 2, high[0] + 2)
    axes.set_ylim(low[1] - 2, high[1] + 2)
    axes.set_aspect("equal")
    axes.grid(False)
    axes.set_xlabel("$x$  [$d$]")
    axes.set_ylabel("$z$  [$d$]")
    axes.legend(loc="upper right", title=f"contacts that make {100 * MOST_OF_IT:.0f} % of all changes", markerscale=1.5)


def draw_loads(axes, contacts, folding):
    """How much the contacts that fold carry, against all that carry a load."""
    edges = np.logspace(-3, 1, 21)
    loaded = contacts.force > 0
    for chosen, color, label in ((loaded, "0.6", "all that carry a load"), (np.isin(np.arange(len(loaded)), folding) & loaded, style.CONTINUUM, "those that fold")):
        count = max(int(chosen.sum()), 1)
        axes.hist(contacts.force[chosen], bins=edges, weights=np.full(int(chosen.sum()), 1 / count), histtype="step", color=color, linewidth=1.8, label=label)
    axes.set_xscale("log")
    axes.set_xlabel(r"$r_n/\langle r_n\rangle$")
    axes.set_ylabel("share of the contacts")
    axes.set_ylim(top=1.3 * axes.get_ylim()[1])
    axes.legend(loc="upper left")


def draw_concentration(axes, contacts):
    """Share of the changes, and of the squared residual, that the first contacts make."""
    for values, color, label in ((contacts.changes, style.CONTINUUM, "changes of state"), (contacts.error**2, style.PARTICLES, "squared residual")):
        sums = np.cumsum(np.sort(values)[::-1])
        if sums[-1] > 0:
            axes.plot(np.arange(1, len(sums) + 1), sums / sums[-1], color=color, label=label)
    axes.set_xscale("log")
    axes.set_xlabel(f"contacts, of {len(contacts.changes)}")
    axes.set_ylabel("share")
    axes.legend(loc="lower right")


def main():
    if len(sys.argv) != 4:
        sys.exit(__doc__)
    contacts = Contacts(sys.argv[1], sys.argv[2])
    folding = contacts.folding()
    style.use_style()
    figure, (whole, loads, concentration) = style.places([1, 2], 4.4)
    draw_places(figure.add_subplot(whole), contacts, folding)
    draw_loads(figure.add_subplot(loads), contacts, folding)
    draw_concentration(figure.add_subplot(concentration), contacts)
    style.save(figure, sys.argv[3], False)


if __name__ == "__main__":
    main()
