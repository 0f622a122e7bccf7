"""Figures of `drumlin measure --study`: those of the paper one by one, bands and bars of 99 %, and what each shows.

usage: study_figures.py FOLDER PAPER RUN...
FOLDER holds study.json and takes the figures; PAPER is data/paper; the runs are in the order of study.json.

figures.json lists them with a caption each: what the paper says, and what was found here.
"""

import functools
import json
import pathlib
import sys

import script
import study_flow
import study_rheology
import study_stresses
import style
import whole_file
from study_runs import Study

# In the order of the paper. Each draws a figure and gives (figure, title, paper says, we find), or None where the runs
# lack what it shows.
FIGURES = [
    ("fig01_snapshot", study_flow.snapshot),
    ("fig02_volume_fraction", study_flow.volume_fraction),
    ("fig03_velocity", study_flow.velocity),
    ("fig04_velocity_along_x", study_flow.velocity_along_x),
    ("fig05_velocity_over_speed", study_flow.velocity_over_speed),
    ("fig06_depth_and_friction", study_flow.depth_and_friction),
    ("fig07_spin", study_flow.spin),
    ("fig08_stresses", study_stresses.stresses),
    ("fig09_stress_gradients", study_stresses.stress_gradients),
    ("fig10_inertial_number", study_rheology.inertial_number),
    ("fig11_rheology", study_rheology.rheology),
    ("fig12_k_gradient", study_stresses.k_gradient),
    ("fig13_fluctuations", study_rheology.fluctuations),
    ("fig14_fluctuations_over_inertia", study_rheology.fluctuations_over_inertia),
    ("volume_fraction_over_inertia", study_rheology.volume_fraction_over_inertia),
]


def main():
    output, paper, *runs = map(pathlib.Path, sys.argv[1:])
    study = Study(output / "study.json", runs, paper)
    style.use_style()
    listed = []

    def save(name, draw):
        drawn = draw(study)
        if drawn is None:
            return
        figure, title, said, here = drawn
        style.save(figure, output / f"{name}.png", study.reduced)
        listed.append({"file": f"{name}.png", "title": title, "paper": said, "here": here})

    def save_list():
        content = {"format": "drumlin-study-figures-1", "figures": listed}
        whole_file.write_text(output / "figures.json", json.dumps(content, indent=2, ensure_ascii=False) + "\n")

    script.draw_each({name: functools.partial(save, name, draw) for name, draw in FIGURES} | {"figures.json": save_list})


if __name__ == "__main__":
    main()
