"""Where simulation and measurement disagree, which effect is missing, and how much of the gap it closes.

measured    what was measured: runs of samples of designs
base        the simulation: curves per design, and how they change with the structure
scene       the runs' pressures and times, ready for models
effects     one effect, one file: its equation, its parameters, its place on the way from pressure to picture
predict     base + effects over a scene
experiment, experiments, trial, separation, next_experiment
            what a bench can do, and which of it tells the rivals apart
explanation what comes out
"""
