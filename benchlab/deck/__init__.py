"""Finite-element models of the whole tube, for checking benchlab in another engine.

grid        lines of a mesh graded to the borders of the layers
tube        design + layup -> nodes, eight-node shells, sections, sets: half a tube with a stiff cap
sheets      ... with a shell for each layer, on shared nodes
solid       ... or in solid elements, layer upon layer
materials   a law as the material cards of Abaqus and CalculiX
sections    nodes, elements, sets and sections as cards
calculix    the model as a CalculiX deck
abaqus      the model as an Abaqus deck
heading     what a deck says of itself
angles      displacements of rib mid-planes -> their rotation
"""
