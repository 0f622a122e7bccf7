"""Many runs together: laws over the speed of rotation, the paper's table, both sides over the speed, limits, the score of a continuum
(docs/formats/study.md, comparison-study.md, score.md).

`drumlin measure --study`, `drumlin compare --study` and `drumlin score` start it; it reads their files with numpy, scipy and h5py."""

from .fields import map_of_fields, read_fields, write_maps
from .fits import Scalar, fit_line, fit_log_friction, fit_power, pooled_speeds
from .laws import collapse, friction_collapse, inertial_curve, speed_laws, speed_trend
from .limits import judged_limits, read_limits, score, traction_ratios
from .paper import paper_entries, verdict_on
from .particles import study_of
from .quantities import with_derived
from .runs import Profile, Run, Speed, read_flow, read_run, require_one_study, same_speed, speed_groups
from .sides import compared_speeds, judged_targets
from .tables import limits_table, paper_table, plain, score_table, shown, speed_table, study_text, verdict_lines
