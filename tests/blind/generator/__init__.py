"""Studies in which an effect is hidden; nothing here knows how it will be looked for.

solved      curves of the shell cell as it is and with something about it changed
runs        what is commanded: slow, fast, held, blocked, or a protocol file
scatter     how samples, runs and readings differ: the noise floor
station     who stands at the bench during a run: samples, clocks, memory
bench       command -> recorded pressure, pressure inside, angle or force, as the camera and the clocks have it
hidden/     one effect a file, with its own mathematics
size        the strength at which an effect moves the readings by so many noise floors
study       all of it drawn from a seed: tables, answer, and more measurements of the same truth
"""
