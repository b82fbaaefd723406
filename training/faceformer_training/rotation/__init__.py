"""The rotation engine's model: one score for each triple of edges, one surface kind for each loop.

The features come from ``faceformer features`` (see core/src/identify/rotation/shards), so that what
is trained on is what the program computes. :mod:`.model` is the network, :mod:`.train` the training
command and :mod:`.export` writes what the program loads.
"""
