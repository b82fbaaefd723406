"""AtlasNet (Groueix et al. 2018), the paper's baseline of reconstruction (section 5): from an image
of the drawing to points on 25 patches, trained by the Chamfer distance.

:mod:`.points` samples true solids, :mod:`.image` draws drawings, :mod:`.model` is the network and
:mod:`.train` the training command, which also measures.
"""
