"""From tensile tests to the coefficients of a law.

curve       the loading curve of one test: first loading, slack removed, up to the break
models      what each law has to be fitted by
regression  least squares with intervals, neighbouring points not taken as independent
fit_law     one law or all of them fitted to the specimens, and which to use
"""
