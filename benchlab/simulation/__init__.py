"""The actuator as a periodically bent shell cell: design + layup -> cell -> bending, volume, moment against pressure.

    laws/       one hyperelastic law, one file: strain energy of a thin sheet in plane stress; its stability
    layup       what the shell is laminated from, and which pieces lie where on the cut sheet
    mesh        nine-node quadrilaterals on a quarter of a cell, finer beside the borders of the fabric
    shell       the director shell at a point: strain energy and enclosed volume, with exact derivatives
    cell        all points of a mesh: energy, gradient and Hessian in the fields and the two global unknowns
    newton      a regularised Newton method that only goes down in energy
    response    free bending, held curvature: the path of states as pressure grows
    actuator_response  whole-actuator quantities: angle, volume, blocked force, tip position
    beam, beam_window  the one-dimensional model that most papers use, to compare with; its windows may balloon or not
    surface, deformed, film_strain  where the sheet has gone to, and how it is strained and stressed there
    identify    the film that makes cells of several designs bend as they do
    inverse     the designs that bend as wanted
    tensile/    the film from tensile tests

To change one thing: a law is a file in `laws/`; a layer more, or a seam, is a piece in `layup.pieces_of`; a load is a term of
`cell.Cell`; the mesh is `mesh.gradings`.
"""
