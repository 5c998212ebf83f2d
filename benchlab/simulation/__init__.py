"""The actuator as a periodically bent shell cell: design + layup -> cell -> bending, volume, moment against pressure.

laws/       one hyperelastic law, one file: strain energy of a thin sheet in plane stress
layup       what the shell is laminated from, and which pieces lie where on the cut sheet
mesh        nine-node quadrilaterals on a quarter of a cell, graded towards the borders of the pieces
shell       the director shell: strain energy and enclosed volume at a point, with exact derivatives
cell        all points of a mesh: energy, gradient and Hessian in the fields and the two global unknowns
newton      a regularised Newton method that only goes down in energy
response    free bending, held curvature: the path of states as pressure grows
actuator_response  whole-actuator quantities: angle, volume, blocked force, tip position
"""
